// Squares of columns around the point, from the inside out.
#include "host_tools/judge/verify/stock_distance.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::verify {

double stock_distance(const HeightGrid& grid,
                      const std::vector<double>& heights,
                      std::size_t point,
                      double top,
                      double max_distance,
                      double sufficient)
{
    const auto i = static_cast<std::ptrdiff_t>(point / grid.ny);
    const auto j = static_cast<std::ptrdiff_t>(point % grid.ny);
    const double x = grid.x(point / grid.ny, point % grid.ny);
    const double y = grid.y(point / grid.ny, point % grid.ny);
    double least = max_distance;
    const auto look_at = [&](std::ptrdiff_t column, std::ptrdiff_t row) {
        if (column < 0 || row < 0 || column >= static_cast<std::ptrdiff_t>(grid.nx) ||
            row >= static_cast<std::ptrdiff_t>(grid.ny)) {
            return;
        }
        const auto at_x = static_cast<std::size_t>(column);
        const auto at_y = static_cast<std::size_t>(row);
        const double height = heights[grid.index(at_x, at_y)];
        if (!std::isfinite(height)) {
            return;
        }
        const double out = elementary::hypot(grid.x(at_x, at_y) - x, grid.y(at_x, at_y) - y);
        least = std::min(least, elementary::hypot(out, std::max(0.0, top - height)));
    };
    // Shifts bring two columns nearer by up to a pitch.
    for (std::ptrdiff_t ring = 0; least > sufficient; ++ring) {
        if (static_cast<double>(ring - 1) * grid.pitch >= least) {
            break;
        }
        for (std::ptrdiff_t k = -ring; k <= ring; ++k) {
            look_at(i + k, j - ring);
            look_at(i + k, j + ring);
            look_at(i - ring, j + k);
            look_at(i + ring, j + k);
        }
    }
    return least;
}

}  // namespace cusp::verify
