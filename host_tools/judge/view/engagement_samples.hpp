// EngagementSamples: the engagement of the tool over the time of a run.
//
// The verification has the engagement at positions of the programmed path; the run has where the
// tip is at each tick, and on which line. Each tick takes the engagement of the position of its line
// that is nearest, and not behind those of earlier ticks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "firmware/base/vec.hpp"
#include "host_tools/judge/verify/engagement_trace.hpp"
#include "host_tools/judge/verify/tool_positions.hpp"
#include "host_tools/judge/view/byte_text.hpp"

namespace cusp::view {

class EngagementSamples {
public:
    static constexpr std::size_t kBucket = 16;  // ticks

    // The runs of a verification, in the order of the program; must outlive this.
    EngagementSamples(const std::vector<verify::ToolPositions>& positions,
                      const std::vector<verify::EngagementRun>& found);

    // The next tick.
    void add(Vec3d tip, std::uint32_t line);

    // Format: a byte for each kBucket ticks: their greatest engagement in whole degrees; 0 in air,
    // in rapid moves and in entries.
    Bytes finish();

private:
    bool has_position() const { return run_ < positions_.size(); }
    void skip_ended_runs();
    void next_position();
    std::uint32_t line_here() const { return positions_[run_].lines[at_]; }
    bool next_is_nearer(Vec3d tip, std::uint32_t line) const;
    void end_bucket();

    const std::vector<verify::ToolPositions>& positions_;
    const std::vector<verify::EngagementRun>& found_;
    std::size_t run_{0};
    std::size_t at_{0};  // position in the run
    std::size_t bucket_ticks_{0};
    float greatest_{0};  // degrees, of the bucket
    Bytes out_;
};

}  // namespace cusp::view
