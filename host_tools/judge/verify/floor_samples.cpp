// The maximum over all points below the ball; a comparison rejects most of them.
#include "host_tools/judge/verify/floor_samples.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::verify {

using drop_cutter::LowestPositionSearch;

FloorSamples::FloorSamples(const HeightGrid& grid, const std::vector<double>& heights)
    : grid_{grid}, heights_{heights}
{
    for (std::size_t k = 0; k < std::max(grid.nx, grid.ny); ++k) {
        shifts_.push_back(grid.shift(k));
    }
}

LowestPositionSearch::DroppedTool FloorSamples::drop_ball(double radius, double x, double y) const
{
    LowestPositionSearch::DroppedTool best{{x, y, -kInfinite}, {}};
    const std::size_t i_end = grid_.end_column(x + radius);
    const std::size_t j_begin = grid_.first_row(y - radius);
    const std::size_t j_end = grid_.end_row(y + radius);
    for (std::size_t i = grid_.first_column(x - radius); i < i_end; ++i) {
        const double column = grid_.x0 + static_cast<double>(i) * grid_.pitch - x;
        const double row = grid_.y0 + shifts_[i] - y;
        for (std::size_t j = j_begin; j < j_end; ++j) {
            const double z = heights_[grid_.index(i, j)];
            if (!(z + radius > best.centre.z)) {
                continue;
            }
            const double dx = column + shifts_[j];
            const double dy = row + static_cast<double>(j) * grid_.pitch;
            const double up = radius * radius - dx * dx - dy * dy;
            const double over = best.centre.z - z;
            if (up > 0 && (over < 0 || up > over * over)) {
                best.centre.z = z + std::sqrt(up);
                best.contact = {x + dx, y + dy, z};
            }
        }
    }
    if (!std::isfinite(best.centre.z)) {
        best.centre.z = kInfinite;
    }
    return best;
}

}  // namespace cusp::verify
