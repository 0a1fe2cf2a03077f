// Feels every move in turn; looks along paths before they are cut.
#include "host_tools/contour_pocket/axial_depth_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/contour_pocket/pocket_toolpath_writer.hpp"
#include "host_tools/toolpath/toolpath_measure.hpp"

namespace cusp::contour_pocket {

using offset::Box2d;
using toolpath::MoveKind;
using toolpath::Tool;
using toolpath::ToolMove;

namespace {

// The metal is known at places only: what stands between them may be this much higher.
constexpr double kBetween = 0.005;   // mm
constexpr double kAimed = 0.9;       // of the depth allowed: what levels take
constexpr double kPitch = 1.0 / 24;  // of the finest tool's radius
constexpr double kChord = 0.002;     // mm: curves are tracked along chords this near
constexpr double kApart = 1.0 / 20;  // of the tool's radius

}  // namespace

AxialDepthTracker::AxialDepthTracker(const Box2d& box, const Tool& finest, double top, double most)
    : stock_{box, finest, top, kPitch}, ahead_{stock_}, max_depth_{most}
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
    for (; tracked_moves_ < path.size(); ++tracked_moves_) {
        for (const Vec3d p : points_of(path[tracked_moves_], at_, kChord)) {
            // Where the first move of a path comes from is over the stock.
            deepest_ = tracked_moves_ > 0 ? std::max(deepest_, stock_.cut(at_, p)) : deepest_;
            at_ = p;
        }
    }
}

// Calls visit(from, to) with places of the path, no farther apart than `apart_`.
template <class Visit>
void AxialDepthTracker::walk(const ClPath& path, Visit visit) const
{
    Vec3d at = path.start;
    visit(at, at);
    for (const ClMove& move : path.moves) {
        for (const Vec3d p : points_of(tool_move(MoveKind::kCut, move), at, kChord)) {
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

std::optional<double> AxialDepthTracker::allowed_height_over(const ClPath& path, double share)
{
    if (max_depth_ == kUnlimitedDepth) {
        return std::nullopt;
    }
    const double most = share * max_depth_;
    double level = -1e300;
    ahead_ = stock_;
    walk(path, [&](Vec3d from, Vec3d to) {
        const double depth = ahead_.cut_with_shrunk_tool(from, to) + kBetween;
        if (depth > most) {
            level = std::max(level, to.z + depth - kAimed * most);
        }
    });
    return level > -1e299 ? std::optional{level} : std::nullopt;
}

double AxialDepthTracker::stock_top_over(const ClPath& path) const
{
    double z = -1e300;
    walk(path, [&](Vec3d, Vec3d to) { z = std::max(z, stock_top_at({to.x, to.y})); });
    return z;
}

double AxialDepthTracker::stock_top_at(Vec2d place) const
{
    return stock_.contact_height(place) + kBetween;
}

double AxialDepthTracker::stock_top_around(Vec2d centre, double radius) const
{
    constexpr int kPlaces = 32;
    double z = -1e300;
    for (int i = 0; i < kPlaces; ++i) {
        const double angle = 2 * kPi * i / kPlaces;
        z = std::max(z, stock_top_at(centre + Vec2d{std::cos(angle), std::sin(angle)} * radius));
    }
    return z;
}

}  // namespace cusp::contour_pocket
