// If a tool can touch the point, one drop suffices; else the lowest position is searched.
#include "host_tools/judge/verify/tool_access.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::verify {

using drop_cutter::LowestPositionSearch;
using nurbs::Surface;
using toolpath::Tool;
using toolpath::ToolShape;

namespace {

constexpr double kPitch = 0.125;        // radii, of the grid of drops
constexpr double kDropAccuracy = 1e-4;  // mm
constexpr double kAgrees = 3e-4;        // mm
constexpr double kTouches = 1e-3;       // mm: nothing is lower than the floor
// Beside cliffs samples seldom decide. After this many consecutive failures they are used only at
// every kAgain-th point.
constexpr int kMostFailures = 4;
constexpr int kAgain = 8;
constexpr int kConeGrid = 6;  // places a radius

}  // namespace

ToolAccess::ToolAccess(const std::vector<Surface>& surfaces,
                       const std::vector<std::array<Vec3d, 3>>& mesh,
                       const std::vector<Tool>& tools,
                       const PocketBoundaries& walls,
                       const FloorSamples& samples,
                       double path_clearance)
    : surfaces_{surfaces},
      mesh_{mesh},
      walls_{walls},
      samples_{samples},
      path_clearance_{path_clearance}
{
    for (const Tool& tool : tools) {
        Tool with_clearance = tool;
        with_clearance.radius += path_clearance;
        with_clearance.corner_radius += path_clearance;
        if (with_clearance.shape == ToolShape::kFlat && path_clearance > 0) {
            with_clearance.shape = ToolShape::kBull;
        }
        cutters_.push_back({tool, with_clearance, {}, {}, {}, 0, 0});
    }
    for (Cutter& cutter : cutters_) {
        const double pitch = kPitch * cutter.tool.radius;
        cutter.search.emplace(
            cutter.tool, path_clearance, pitch, kAgrees,
            [this, &cutter](double x, double y) { return drop_at(cutter, x, y); });
        if (cutter.tool.shape == ToolShape::kBall) {
            cutter.on_samples.emplace(
                cutter.tool, path_clearance, pitch, kAgrees,
                [this, &cutter](double x, double y) { return drop_on_samples(cutter, x, y); });
        }
    }
}

bool ToolAccess::within_walls(const Cutter& cutter, double x, double y) const
{
    return !(walls_.at(x, y) < cutter.tool.radius);
}

LowestPositionSearch::DroppedTool ToolAccess::drop_on_samples(const Cutter& cutter,
                                                              double x,
                                                              double y) const
{
    return within_walls(cutter, x, y) ? samples_.drop_ball(cutter.grown_tool.radius, x, y)
                                      : LowestPositionSearch::DroppedTool{{x, y, kInfinite}, {}};
}

LowestPositionSearch::DroppedTool ToolAccess::drop_at(Cutter& cutter, double x, double y)
{
    LowestPositionSearch::DroppedTool rest{{x, y, kInfinite}, {}};
    if (!within_walls(cutter, x, y)) {
        return rest;
    }
    if (!surfaces_.empty()) {
        if (!cutter.floor) {
            cutter.floor.emplace(surfaces_, cutter.grown_tool, kDropAccuracy);
        }
        rest = drop_tool(*cutter.floor, x, y);
    }
    if (!mesh_.empty()) {
        if (!model_) {
            model_.emplace(mesh_);
        }
        if (const auto tip = model_->drop_height(cutter.grown_tool, x, y)) {
            const double height = *tip + cutter.grown_tool.corner_radius;
            if (rest.centre.z == kInfinite || height > rest.centre.z) {
                rest.centre.z = height;
                rest.contact =
                    model_->distance(cutter.grown_tool, {x, y, *tip}, kTouches).nearest.point;
            }
        }
    }
    return rest;
}

double ToolAccess::lowest_of_cone(Cutter& cutter, Vec3d place, Vec2d touching)
{
    const Tool& tool = cutter.tool;
    double lowest = kInfinite;
    Vec2d best = touching;
    const auto try_at = [&](Vec2d at) {
        const double away = norm(at - Vec2d{place.x, place.y});
        if (!(away <= tool.radius)) {
            return false;
        }
        const double end = drop_at(cutter, at.x, at.y).centre.z;
        const double height =
            end - cutter.grown_tool.corner_radius + path_clearance_ + profile_height(tool, away);
        if (!(height < lowest)) {
            return false;
        }
        lowest = height;
        best = at;
        return true;
    };
    try_at(touching);
    if (lowest <= place.z + kTouches + path_clearance_) {
        return lowest;
    }
    for (int i = -kConeGrid; i <= kConeGrid; ++i) {
        for (int j = -kConeGrid; j <= kConeGrid; ++j) {
            const double pitch = tool.radius / kConeGrid;
            try_at({place.x + i * pitch, place.y + j * pitch});
        }
    }
    for (double step = 0.5 * tool.radius / kConeGrid; step > kAgrees;) {
        bool better = false;
        for (const Vec2d way : {Vec2d{1, 0}, Vec2d{0, 1}, Vec2d{-1, 0}, Vec2d{0, -1}}) {
            better = try_at(best + way * step) || better;
        }
        step *= better ? 1 : 0.5;
    }
    return lowest;
}

double ToolAccess::lowest_over(Vec3d place, Vec3d normal, double exact_below)
{
    double lowest = kInfinite;
    for (Cutter& cutter : cutters_) {
        // the position of a tool that touches the point
        const double level = elementary::hypot(normal.x, normal.y);
        const double flat = flat_radius(cutter.tool);
        const double out = cutter.grown_tool.corner_radius + (level > 0 ? flat / level : 0.0);
        const Vec2d touching{place.x + out * normal.x, place.y + out * normal.y};
        if (is_conical(cutter.tool)) {
            lowest = std::min(lowest, lowest_of_cone(cutter, place, touching));
            continue;
        }
        const double touched =
            place.z + kTouches + (1 / std::max(normal.z, 0.05)) * path_clearance_;
        const double lower = std::min(exact_below, lowest);
        if (cutter.on_samples &&
            (cutter.failures < kMostFailures || ++cutter.skipped % kAgain == 0)) {
            // The first lower position suffices: the floor itself then decides.
            const double sufficient = std::nextafter(lower, -kInfinite);
            const auto hoped = cutter.on_samples->lowest_over(place, lower, sufficient, touching);
            if (hoped && hoped->height >= lower) {
                cutter.failures = 0;
                lowest = std::min(lowest, hoped->height);
                continue;
            }
            ++cutter.failures;
        }
        const auto answer = cutter.search->lowest_over(place, lower, touched, touching);
        if (answer) {
            lowest = std::min(lowest, answer->height);
        }
        if (lowest <= touched) {
            break;
        }
    }
    return std::max(lowest, place.z);
}

}  // namespace cusp::verify
