// Moves are halved until what lies between two known places can not matter.
#include "host_tools/grid_pocket/flat_end_drop_cutter.hpp"

#include <algorithm>

namespace cusp::grid_pocket {

using drop_cutter::DropCutter;
using nurbs::Surface;
using offset::Box2d;
using toolpath::Tool;

namespace {

// What is this little below needs no closer look: it is divided or lifted in any case.
constexpr double kTooLow = -1e-6;

// Moves shorter than this get the bound that they have.
constexpr double kShortest = 0.01;

Tool widened(Tool tool, double by)
{
    tool.radius += by;
    return tool;
}

Box2d plan_box(Vec3d a, Vec3d b)
{
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::max(a.x, b.x), std::max(a.y, b.y)};
}

}  // namespace

FlatEndDropCutter::FlatEndDropCutter(const std::vector<Surface>& floor,
                                     const Tool& tool,
                                     double accuracy)
    : floor_{floor, tool, accuracy},
      wide_{floor, widened(tool, std::min(20 * accuracy, tool.radius / 50)), accuracy},
      bend_{floor, tool.radius},
      wider_{std::min(20 * accuracy, tool.radius / 50)}
{
}

std::optional<double> FlatEndDropCutter::height(Vec2d at) const
{
    const std::optional<DropCutter::ClPoint> cl = floor_.drop(at);
    return cl ? std::optional{cl->z} : std::nullopt;
}

double FlatEndDropCutter::over(Vec3d tip) const
{
    if (known_.x != tip.x || known_.y != tip.y) {
        known_ = {tip.x, tip.y, floor_.tip_height({tip.x, tip.y})};
    }
    return tip.z - known_.z;
}

double FlatEndDropCutter::move_clearance(Vec3d a, Vec3d b) const
{
    const double over_a = over(a);
    const double over_b = over(b);
    return clearance_between(a, over_a, b, over_b);
}

double FlatEndDropCutter::clearance_between(Vec3d a, double over_a, Vec3d b, double over_b) const
{
    const double ends = std::min({over_a, over_b, 0.0});
    const Vec3d way = b - a;
    const double length = norm(in_plan(way));
    if (ends < kTooLow || length < 1e-9) {
        return ends;
    }
    if (!bend_.is_bent_near(plan_box(a, b))) {
        const double least = std::min(over_a, over_b) - bend_.max_bend() * length * length / 8;
        if (least >= 0 || length < kShortest) {
            return std::min(least, 0.0);
        }
    } else if (length <= 2 * wider_) {
        const Vec3d middle = (a + b) * 0.5;
        return std::min({std::min(a.z, b.z) - wide_.tip_height({middle.x, middle.y}), 0.0});
    }
    const Vec3d middle = (a + b) * 0.5;
    const double there = middle.z - floor_.tip_height({middle.x, middle.y});
    const double first = clearance_between(a, over_a, middle, there);
    return first < kTooLow ? first : std::min(first, clearance_between(middle, there, b, over_b));
}

}  // namespace cusp::grid_pocket
