// The distance of a point from the core is convex along a move: tangents lead to its least value.
#include "host_tools/cam/finishing/swept_tool.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/tool_cap.hpp"

namespace cusp::finishing {

using part_model::cap_reach;
using part_model::square_key;
using part_model::ToolCore;

namespace {

constexpr double kSquarePitch = 0.6;       // of the width of a pass on level ground
constexpr double kWindowWider = 1.05;      // of a window: scallops do not end at its border
constexpr double kLevelGroundTilt = 1e-9;  // z of a normal
constexpr int kMostTangents = 30;
constexpr double kNearby = 0.1;          // radii
constexpr double kExactTangents = 1e-9;  // mm

// A core that is smaller all round, where the corner radius is less than that.
ToolCore shrunk(ToolCore core, double by)
{
    if (by > 0) {
        const double secant = std::sqrt(1 + core.widening * core.widening);
        core.end.z += by;
        core.radius += core.widening * by - secant * by;
        if (core.radius < 0) {
            core.end.z -= core.widening > 0 ? core.radius / core.widening : 0;
            core.radius = 0;
        }
        core.widest = std::max(core.radius, core.widest - by);
    }
    return core;
}

}  // namespace

SweptTool::SweptTool(const toolpath::Tool& tool, double height) : profile_{tool}, height_{height}
{
    const double wide = 2 * cap_reach(profile_, {0, 0, 1}, {1, 0, 0}, height);
    pitch_ = kSquarePitch * std::min(wide, profile_.radius());
}

std::int64_t SweptTool::cell(double at) const
{
    return static_cast<std::int64_t>(std::floor(at / pitch_));
}

// Each square that the move crosses, seen from above: squares along the longer way, two or three across.
void SweptTool::add(const std::vector<Vec3d>& tips)
{
    const Vec3d up{0, 0, profile_.corner()};
    for (std::size_t k = 1; k < tips.size(); ++k) {
        const Move move{tips[k - 1] + up, tips[k] + up};
        const auto number = static_cast<std::uint32_t>(moves_.size());
        moves_.push_back(move);
        const Vec3d way = move.to - move.from;
        const bool by_x = std::abs(way.x) >= std::abs(way.y);
        const double run = by_x ? way.x : way.y;
        const double from = by_x ? move.from.x : move.from.y;
        const double side = by_x ? move.from.y : move.from.x;
        const double slope = run != 0 ? (by_x ? way.y : way.x) / run : 0;
        const double low = std::min(from, from + run);
        const double high = std::max(from, from + run);
        for (std::int64_t i = cell(low); i <= cell(high); ++i) {
            const double a = std::max(low, static_cast<double>(i) * pitch_);
            const double b = std::min(high, static_cast<double>(i + 1) * pitch_);
            const double at_a = side + slope * (a - from);
            const double at_b = side + slope * (b - from);
            for (std::int64_t j = cell(std::min(at_a, at_b)); j <= cell(std::max(at_a, at_b));
                 ++j) {
                squares_[by_x ? square_key(i, j) : square_key(j, i)].push_back(number);
            }
        }
    }
}

ToolWindow SweptTool::window(Vec3d normal, double offset) const
{
    ToolWindow out;
    const ToolCore& core = profile_.core();
    out.off = normal * (profile_.corner() + offset) - core.farthest_against(normal);
    const double tilt = elementary::hypot(normal.x, normal.y);
    const Vec3d level =
        tilt > kLevelGroundTilt ? Vec3d{-normal.y, normal.x, 0} / tilt : Vec3d{1, 0, 0};
    const Vec3d up = cross(normal, level);  // never downward
    const double height = height_ + offset;
    const double aside = kWindowWider * cap_reach(profile_, normal, level, height);
    const double above = kWindowWider * cap_reach(profile_, normal, up, height);
    const double below = kWindowWider * cap_reach(profile_, normal, -up, height);
    const double flat = elementary::hypot(up.x, up.y);
    // The end is lower, and farther down the slope, where a higher place of the tool touches.
    const bool endless = !(above < kInfinite);
    const double middle = endless ? 0 : 0.5 * (below - above);
    out.middle = out.off + Vec3d{up.x, up.y, 0} * middle;
    out.around =
        elementary::hypot(flat * (endless ? below : 0.5 * (above + below)), aside) + 2 * height_;
    out.high = out.off.z + std::abs(up.z) * below + 2 * height_;
    out.low = endless ? -kInfinite : out.off.z - std::abs(up.z) * above - 2 * height_;
    return out;
}

// A ball's core is a point and everything above it: the nearest place is that in space, that in plan, or
// where the move is as high as the point.
double SweptTool::point_apart(const Move& move, Vec3d point)
{
    const Vec3d way = move.to - move.from;
    const Vec3d off = point - move.from;
    const double plan = way.x * way.x + way.y * way.y;
    const double square = plan + way.z * way.z;
    const double along = off.x * way.x + off.y * way.y;
    double t = square > 0 ? std::clamp((along + off.z * way.z) / square, 0.0, 1.0) : 0;
    if (off.z > t * way.z) {
        const double seen = plan > 0 ? std::clamp(along / plan, 0.0, 1.0) : (way.z < 0 ? 1.0 : 0.0);
        t = off.z >= seen * way.z ? seen : off.z / way.z;
    }
    const Vec3d rest = off - way * t;
    const double down = std::min(0.0, rest.z);
    return std::sqrt(rest.x * rest.x + rest.y * rest.y + down * down);
}

double SweptTool::core_apart(
    const Move& move, const ToolCore& core, Vec3d point, double enough, double far)
{
    if (core.is_point()) {
        return point_apart(move, point - core.end);
    }
    const Vec3d way = move.to - move.from;
    const double length = norm(way);
    const Vec3d along = length > 0 ? way / length : Vec3d{};
    struct Place {
        double at;
        double distance;
        double slope;
    };
    const auto place = [&](double s) {
        ToolCore out = core;
        out.end = core.end + move.from + along * s;
        const Vec3d reach = out.reach(point);
        const double distance = norm(reach);
        return Place{s, distance, distance > 0 ? -dot(reach, along) / distance : 0};
    };
    Place low = place(std::clamp(dot(point - core.end - move.from, along), 0.0, length));
    if (low.distance <= enough || low.slope == 0) {
        return low.distance;
    }
    Place high = low;
    (low.slope < 0 ? high : low) = place(low.slope < 0 ? length : 0);
    // Tangents from either end meet below the least distance; the places where they meet converge.
    for (int k = 0; k < kMostTangents; ++k) {
        const Place& least = low.distance < high.distance ? low : high;
        if (least.distance <= enough || low.slope >= 0 || high.slope <= 0) {
            return least.distance;
        }
        const double between =
            std::clamp((high.distance - low.distance + low.slope * low.at - high.slope * high.at) /
                           (low.slope - high.slope),
                       low.at, high.at);
        const double bound = low.distance + low.slope * (between - low.at);
        if (bound > far || least.distance - bound < kExactTangents) {
            return bound > far ? bound : least.distance;
        }
        const Place middle = place(between);
        if (middle.slope == 0) {
            return middle.distance;
        }
        (middle.slope < 0 ? low : high) = middle;
    }
    return std::min(low.distance, high.distance);
}

bool SweptTool::removes(std::uint32_t move, Vec3d point, double shrink) const
{
    const double corner = profile_.corner() - shrink;
    const double enough = std::max(0.0, corner);
    if (profile_.core().is_point() && corner > 0) {
        return point_apart(moves_[move], point) <= enough;
    }
    const ToolCore core = shrunk(profile_.core(), -corner);
    return core_apart(moves_[move], core, point, enough, enough) <= enough;
}

double SweptTool::distance(Vec3d point, double most, double enough) const
{
    const double corner = profile_.corner();
    double least = most;
    // Most are near: first a little round the tool, then as far as is asked.
    for (const double far : {std::min(most, kNearby * profile_.radius()), most}) {
        // The end of the core is the tool's lowest place but for the corner.
        const ToolWindow all{{}, {}, profile_.radius() + far, -kInfinite, corner + far};
        least = far;
        any_through(all, point, [&](std::uint32_t number) {
            const double apart =
                core_apart(moves_[number], profile_.core(), point, corner + enough, corner + least);
            least = std::min(least, std::max(0.0, apart - corner));
            return least <= enough;
        });
        if (least < far) {
            break;
        }
    }
    return least;
}

}  // namespace cusp::finishing
