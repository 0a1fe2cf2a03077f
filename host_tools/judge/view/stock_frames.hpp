// StockFrames: the stock as a height map at some sixty times of a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/machined_stock.hpp"
#include "host_tools/judge/view/byte_text.hpp"

namespace cusp::view {

// Tool positions that cut the stock, thinned, for each tool in turn.
class CuttingPath {
public:
    // spacing  mm between positions
    explicit CuttingPath(double spacing) : spacing_{spacing} {}

    // The position at a tick. tool: its T word.
    void add(Vec3d tip, std::uint64_t tick, int tool, bool rapid);

    struct Run {
        int tool;
        std::vector<Vec3d> tips;
        std::vector<bool> rapid;
        std::vector<std::uint64_t> ticks;
    };
    const std::vector<Run>& runs() const { return runs_; }

private:
    double spacing_;
    std::vector<Run> runs_;
};

// The grid of the page: at most some 90 000 points, without shifts, of the same area.
verify::HeightGrid coarse_grid(const verify::HeightGrid& fine);

// Format: u32 columns, rows, frames; f64 x0, y0, pitch, low, high; f64 tick of each frame but the
// first; then for each frame but the first, which is the uncut stock (high), the height removed since
// the previous frame in steps of (high - low) / 65535: all low bytes, then all high bytes, rows of y
// within a column. Deflated except the numbers before.
Bytes stock_frames(const CuttingPath& path, const job::Job& job, const verify::HeightGrid& grid);

}  // namespace cusp::view
