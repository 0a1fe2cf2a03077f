// Positions are stored in squares in plan.
#include "host_tools/judge/verify/residual_thickness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::verify {

using toolpath::Tool;

namespace {

constexpr double kSquaresPerRadius = 4;
constexpr double kMostSquares = 1e6;

// mm from a place to the tool; 0 or less inside.
double distance_to(const Tool& tool, Vec3d tip, Vec3d place)
{
    const double out = elementary::hypot(place.x - tip.x, place.y - tip.y);
    const double over = place.z - tip.z;
    if (over >= tool.corner_radius) {
        return out - tool.radius;
    }
    const double beside = std::max(0.0, out - (tool.radius - tool.corner_radius));
    return elementary::hypot(beside, tool.corner_radius - over) - tool.corner_radius;
}

}  // namespace

ResidualThickness::ResidualThickness(const std::vector<ToolPositions>& runs, double top)
    : runs_{runs}
{
    Vec2d low{kInfinite, kInfinite};
    Vec2d high{-kInfinite, -kInfinite};
    const auto for_each_position = [&](auto visit) {
        for (std::size_t run = 0; run < runs.size(); ++run) {
            for (std::size_t k = 0; k < runs[run].tips.size(); ++k) {
                if (runs[run].tips[k].z < top) {
                    visit(run, k, runs[run].tips[k]);
                }
            }
        }
    };
    double least = kInfinite;
    for (const ToolPositions& run : runs) {
        widest_ = std::max(widest_, run.tool.radius);
        least = std::min(least, run.tool.radius);
    }
    for_each_position([&](std::size_t, std::size_t, Vec3d tip) {
        low = {std::min(low.x, tip.x), std::min(low.y, tip.y)};
        high = {std::max(high.x, tip.x), std::max(high.y, tip.y)};
    });
    if (!(low.x <= high.x)) {
        return;
    }
    x0_ = low.x;
    y0_ = low.y;
    pitch_ = std::max(least / kSquaresPerRadius,
                      std::sqrt((high.x - low.x) * (high.y - low.y) / kMostSquares));
    nx_ = static_cast<std::size_t>((high.x - low.x) / pitch_) + 1;
    ny_ = static_cast<std::size_t>((high.y - low.y) / pitch_) + 1;
    cells_.resize(nx_ * ny_);
    for_each_position([&](std::size_t run, std::size_t k, Vec3d tip) {
        cells_[cell(tip.x, x0_, nx_) * ny_ + cell(tip.y, y0_, ny_)].push_back(
            {static_cast<std::uint32_t>(run), static_cast<std::uint32_t>(k)});
    });
}

std::size_t ResidualThickness::cell(double at, double first, std::size_t count) const
{
    const double place = std::max(0.0, (at - first) / pitch_);
    return place < static_cast<double>(count) ? static_cast<std::size_t>(place) : count - 1;
}

double ResidualThickness::at(Vec3d place, double max_distance, double sufficient) const
{
    double least = max_distance;
    if (cells_.empty()) {
        return least;
    }
    const double reach = widest_ + max_distance;
    const std::size_t j_begin = cell(place.y - reach, y0_, ny_);
    const std::size_t j_end = cell(place.y + reach, y0_, ny_) + 1;
    const std::size_t i_end = cell(place.x + reach, x0_, nx_) + 1;
    for (std::size_t i = cell(place.x - reach, x0_, nx_); i < i_end; ++i) {
        for (std::size_t j = j_begin; j < j_end; ++j) {
            for (const Position at : cells_[i * ny_ + j]) {
                const ToolPositions& run = runs_[at.run];
                least = std::min(least, distance_to(run.tool, run.tips[at.number], place));
                if (least <= sufficient) {
                    return least;
                }
            }
        }
    }
    return least;
}

}  // namespace cusp::verify
