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
// Beside cliffs, which samples say little of: places in a row where they were no help, and how
// often they are asked from there on.
constexpr int kInVain = 4;
constexpr int kAgain = 8;

}  // namespace

FloorReach::FloorReach(const std::vector<Surface>& surfaces,
                       const std::vector<std::array<Vec3d, 3>>& mesh,
                       const std::vector<Tool>& tools,
                       const std::vector<WallDistance>& walls,
                       const FloorSamples& samples,
                       double keep_off)
    : surfaces_{surfaces}, mesh_{mesh}, walls_{walls}, samples_{samples}, keep_off_{keep_off}
{
    for (const Tool& tool : tools) {
        Tool kept_off = tool;
        kept_off.radius += keep_off;
        kept_off.corner_radius += keep_off;
        if (kept_off.shape == ToolShape::kFlat && keep_off > 0) {
            kept_off.shape = ToolShape::kBull;
        }
        cutters_.push_back({tool, kept_off, {}, {}, {}, 0, 0});
    }
    for (Cutter& cutter : cutters_) {
        const double pitch = kPitch * cutter.tool.radius;
        cutter.search.emplace(
            cutter.tool, keep_off, pitch, kAgrees,
            [this, &cutter](double x, double y) { return dropped(cutter, x, y); });
        if (cutter.tool.shape == ToolShape::kBall) {
            cutter.on_samples.emplace(
                cutter.tool, keep_off, pitch, kAgrees,
                [this, &cutter](double x, double y) { return dropped_on_samples(cutter, x, y); });
        }
    }
}

bool FloorReach::within_walls(const Cutter& cutter, double x, double y) const
{
    return std::none_of(walls_.begin(), walls_.end(), [&](const WallDistance& wall) {
        return wall.at(x, y) < cutter.tool.radius;
    });
}

ReachSearch::Rest FloorReach::dropped_on_samples(const Cutter& cutter, double x, double y) const
{
    return within_walls(cutter, x, y) ? samples_.rest(cutter.kept_off.radius, x, y)
                                      : ReachSearch::Rest{{x, y, kUnreached}, {}};
}

ReachSearch::Rest FloorReach::dropped(Cutter& cutter, double x, double y)
{
    ReachSearch::Rest rest{{x, y, kUnreached}, {}};
    if (!within_walls(cutter, x, y)) {
        return rest;
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
        const double lower = std::min(worth, lowest);
        if (cutter.on_samples && (cutter.in_vain < kInVain || ++cutter.skipped % kAgain == 0)) {
            // The first position that gets lower is enough to ask the floor itself.
            const double enough = std::nextafter(lower, -kUnreached);
            const auto hoped = cutter.on_samples->over(place, lower, enough, touching);
            if (hoped && hoped->height >= lower) {
                cutter.in_vain = 0;
                lowest = std::min(lowest, hoped->height);
                continue;
            }
            ++cutter.in_vain;
        }
        const auto answer = cutter.search->over(place, lower, touched, touching);
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
