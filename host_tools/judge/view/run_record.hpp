// RunRecord: encodes the set points of a run for a page, and measures their deviation, tick by
// tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "firmware/path/move.hpp"
#include "host_tools/controller/program_run/path_deviation.hpp"
#include "host_tools/controller/program_run/program_run.hpp"
#include "host_tools/judge/verify/verify.hpp"
#include "host_tools/judge/view/engagement_samples.hpp"
#include "host_tools/judge/view/path_vertices.hpp"
#include "host_tools/judge/view/program_reading.hpp"
#include "host_tools/judge/view/sample_blocks.hpp"
#include "host_tools/judge/view/stock_frames.hpp"

namespace cusp::view {

// A piece of a run.
struct RunPiece {
    // A move of the programmed path; none: the machine has moved by itself.
    struct PathEvent {
        std::size_t before;  // this one of `points`
        std::optional<path::Move> move;
    };
    std::vector<program_run::SetPoint> points;
    std::vector<PathEvent> path;
};

class RunRecord {
public:
    // reading  must outlive this
    // spacing  mm between the positions that cut the stock
    RunRecord(const ProgramReading& reading, double spacing) : reading_{reading}, path_{spacing} {}

    // The engagement of the ticks that follow is recorded too; `cut` must outlive this.
    void follow_engagement(const verify::Verification& cut)
    {
        engagement_.emplace(cut.positions, cut.engagement);
    }

    // The next ticks.
    void add(const RunPiece& batch);

    std::uint64_t ticks() const { return samples_.ticks(); }
    // Time of the first set point on the clock of the pulse trace, microseconds.
    std::uint64_t start() const { return start_; }

    // Greatest distance of an axis from the first set point, nm.
    std::int64_t farthest() const { return farthest_; }

    // From the programmed path, of all set points.
    const program_run::PathDeviation& deviation() const { return deviation_; }

    SampleBlocks& samples() { return samples_; }
    PathVertices& vertices() { return vertices_; }
    const CuttingPath& path() const { return path_; }
    std::optional<EngagementSamples>& engagement() { return engagement_; }

    // Format: u32 runs of one line; for each its length in ticks (varint) and the difference of its
    // line to that of the previous run (zigzag varint).
    Bytes line_runs();

private:
    void add(const program_run::SetPoint& point);
    void end_line_run();

    const ProgramReading& reading_;
    program_run::PathDeviation deviation_;
    SampleBlocks samples_;
    PathVertices vertices_;
    CuttingPath path_;
    std::optional<EngagementSamples> engagement_;
    Bytes runs_;
    std::uint64_t run_count_{0};
    std::uint64_t run_ticks_{0};
    std::uint32_t line_{0};
    std::int64_t written_line_{0};
    std::uint64_t start_{0};
    Position start_at_{};
    std::int64_t farthest_{0};
};

}  // namespace cusp::view
