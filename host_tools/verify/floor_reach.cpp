// Where a tool can touch the place one drop tells; else it is searched for.
#include "host_tools/verify/floor_reach.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::host {
namespace {

constexpr double kUnreached = ReachSearch::kNowhere;
constexpr double kPitch = 0.125;        // radii, of the grid of drops
constexpr double kDropAccuracy = 1e-4;  // mm
constexpr double kAgrees = 3e-4;        // mm
constexpr double kTouches = 1e-3;       // mm: nothing is lower than the floor

}  // namespace

FloorReach::FloorReach(const std::vector<Surface>& surfaces,
                       const std::vector<std::array<Vec3d, 3>>& mesh,
                       const std::vector<Tool>& tools,
                       const std::vector<WallDistance>& walls,
                       double keep_off)
    : surfaces_{surfaces}, mesh_{mesh}, walls_{walls}, keep_off_{keep_off}
{
    for (const Tool& tool : tools) {
        Tool kept_off = tool;
        kept_off.radius += keep_off;
        kept_off.corner_radius += keep_off;
        if (kept_off.shape == ToolShape::kFlat && keep_off > 0) {
            kept_off.shape = ToolShape::kBull;
        }
        cutters_.push_back({tool, kept_off, {}, {}});
    }
    for (Cutter& cutter : cutters_) {
        cutter.search.emplace(
            cutter.tool, keep_off, kPitch * cutter.tool.radius, kAgrees,
            [this, &cutter](double x, double y) { return dropped(cutter, x, y); });
    }
}

ReachSearch::Rest FloorReach::dropped(Cutter& cutter, double x, double y)
{
    ReachSearch::Rest rest{{x, y, kUnreached}, {}};
    for (const WallDistance& wall : walls_) {
        if (wall.at(x, y) < cutter.tool.radius) {
            return rest;
        }
    }
    if (!surfaces_.empty()) {
        if (!cutter.floor) {
            cutter.floor.emplace(surfaces_, cutter.kept_off, kDropAccuracy);
        }
        rest = rest_on(*cutter.floor, x, y);
    }
    if (!mesh_.empty()) {
        if (!model_) {
            model_.emplace(mesh_);
        }
        if (const auto tip = model_->drop(cutter.kept_off, x, y)) {
            const double height = *tip + cutter.kept_off.corner_radius;
            if (rest.centre.z == kUnreached || height > rest.centre.z) {
                rest.centre.z = height;
                rest.contact =
                    model_->clearance(cutter.kept_off, {x, y, *tip}, kTouches).nearest.point;
            }
        }
    }
    return rest;
}

double FloorReach::lowest_over(Vec3d place, Vec3d normal, double worth)
{
    double lowest = kUnreached;
    for (Cutter& cutter : cutters_) {
        // a tool that rests on the place stands here
        const double level = std::hypot(normal.x, normal.y);
        const double flat = cutter.tool.radius - cutter.tool.corner_radius;
        const double out = cutter.kept_off.corner_radius + (level > 0 ? flat / level : 0.0);
        const Vec2d touching{place.x + out * normal.x, place.y + out * normal.y};
        const double touched = place.z + kTouches + (1 / std::max(normal.z, 0.05)) * keep_off_;
        const auto answer = cutter.search->over(place, std::min(worth, lowest), touched, touching);
        if (answer) {
            lowest = std::min(lowest, answer->height);
        }
        if (lowest <= touched) {
            break;
        }
    }
    return std::max(lowest, place.z);
}

}  // namespace cusp::host
