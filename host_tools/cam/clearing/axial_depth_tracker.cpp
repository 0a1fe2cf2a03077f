// Cuts a stock height map move by move; cuts of moves ahead are taken back.
#include "host_tools/cam/clearing/axial_depth_tracker.hpp"

#include <algorithm>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::clearing {

using offset::Box2d;
using toolpath::Tool;
using toolpath::ToolMove;

namespace {

// The stock is known at points only: between them it may be higher by this much.
constexpr double kBetween = 0.005;   // mm
constexpr double kAimed = 0.9;       // share of the allowed depth for cuts at a raised height
constexpr double kChord = 0.002;     // mm: tolerance of chords of curves
constexpr double kApart = 1.0 / 20;  // of the tool's radius

}  // namespace

AxialDepthTracker::AxialDepthTracker(
    const Box2d& box, const Tool& finest, double top, std::optional<double> max_depth, double share)
    : stock_{box, finest, top, share}, max_depth_{max_depth}
{
    begin(finest);
}

void AxialDepthTracker::begin(const Tool& tool)
{
    stock_.set_tool(tool);
    apart_ = kApart * tool.radius;
    tracked_moves_ = 0;
}

void AxialDepthTracker::track(const std::vector<ToolMove>& path)
{
    std::vector<StockHeightMap::Move> moves;
    for (; tracked_moves_ < path.size(); ++tracked_moves_) {
        for (const Vec3d p : points_of(path[tracked_moves_], at_, kChord)) {
            // The start of a path's first move is above the stock.
            if (tracked_moves_ > 0) {
                moves.push_back({at_, p});
            }
            at_ = p;
        }
    }
    for (const double depth : stock_.cut(moves)) {
        deepest_ = std::max(deepest_, depth);
    }
}

// Calls visit(from, to) for points of the moves, at most `apart_` apart.
template <class Visit>
void AxialDepthTracker::walk(Vec3d start, const std::vector<ToolMove>& moves, Visit visit) const
{
    Vec3d at = start;
    visit(at, at);
    for (const ToolMove& move : moves) {
        for (const Vec3d p : points_of(move, at, kChord)) {
            const int n = 1 + static_cast<int>(norm(p - at) / apart_);
            Vec3d from = at;
            for (int i = 1; i <= n; ++i) {
                const Vec3d to = at + (p - at) * (static_cast<double>(i) / n);
                visit(from, to);
                from = to;
            }
            at = p;
        }
    }
}

std::optional<double> AxialDepthTracker::allowed_height_over(Vec3d start,
                                                             const std::vector<ToolMove>& moves,
                                                             double share)
{
    if (!max_depth_) {
        return std::nullopt;
    }
    const double limit = share * *max_depth_;
    std::optional<double> height;
    std::vector<StockHeightMap::Move> steps;
    walk(start, moves, [&](Vec3d from, Vec3d to) { steps.push_back({from, to}); });
    stock_.begin_trial();
    const std::vector<double> deepest = stock_.cut_with_shrunk_tool(steps);
    stock_.end_trial();
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const double depth = deepest[k] + kBetween;
        if (depth > limit) {
            const double here = steps[k].to.z + depth - kAimed * limit;
            height = std::max(height.value_or(here), here);
        }
    }
    return height;
}

double AxialDepthTracker::stock_top_over(Vec3d start, const std::vector<ToolMove>& moves) const
{
    double z = -kUnbounded;
    walk(start, moves, [&](Vec3d, Vec3d to) { z = std::max(z, stock_top_at(in_plan(to))); });
    return z;
}

double AxialDepthTracker::stock_top_at(Vec2d place) const
{
    return stock_.contact_height(place) + kBetween;
}

double AxialDepthTracker::most_stock_top_near(Vec2d place, double within) const
{
    return stock_.most_contact_height(place, within) + kBetween;
}

double AxialDepthTracker::stock_top_around(Vec2d centre, double radius) const
{
    constexpr int kPlaces = 32;
    double z = -kUnbounded;
    for (int i = 0; i < kPlaces; ++i) {
        const double angle = 2 * kPi * i / kPlaces;
        z = std::max(
            z,
            stock_top_at(centre + Vec2d{elementary::cos(angle), elementary::sin(angle)} * radius));
    }
    return z;
}

}  // namespace cusp::clearing
