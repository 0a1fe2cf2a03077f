// A distance transform of the points that have a surface.
#include "host_tools/judge/verify/finished_ground.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/job/job/finish_keys.hpp"
#include "host_tools/judge/verify/distance_transform.hpp"

namespace cusp::verify {

using job::Operation;

bool stays_with_ground(const Operation& operation)
{
    return job::finishes_ground(operation) && !operation.passes.roughing &&
           std::all_of(operation.tools.begin(), operation.tools.end(),
                       [&](const auto& tool) { return tool.number == operation.tool.number; });
}

FinishedGround::FinishedGround(const Operation& operation,
                               const std::vector<double>& heights,
                               const HeightGrid& grid)
    : grid_{grid}
{
    constexpr double kPitches =
        4;  // shifts of the grid, the place between its points, the transform
    reach_ = 2 * operation.tool.radius + kPitches * grid.pitch;
    std::vector<char> ground(heights.size());
    for (std::size_t k = 0; k < heights.size(); ++k) {
        ground[k] = std::isfinite(heights[k]) ? 1 : 0;
    }
    away_ = distances_from(ground, grid);
}

double FinishedGround::room(double x, double y) const
{
    const auto nearest = [&](double at, std::size_t count) {
        return static_cast<std::size_t>(
            std::clamp(std::round(at / grid_.pitch), 0.0, static_cast<double>(count - 1)));
    };
    const std::size_t i = nearest(x - grid_.x0, grid_.nx);
    const std::size_t j = nearest(y - grid_.y0, grid_.ny);
    return reach_ - away_[grid_.index(i, j)];
}

}  // namespace cusp::verify
