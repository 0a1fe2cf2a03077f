// Arcs in polar form.
#include "host_tools/geometry/toolpath/arc_geometry.hpp"

#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::toolpath {
namespace {

constexpr double kTurn = 2 * kPi;
// Ends closer than this (mm) are the same point: a full turn.
constexpr double kSamePoint = 1e-9;

double swept(double from, double to, bool clockwise)
{
    const double sweep = std::remainder(to - from, kTurn);
    if (clockwise) {
        return sweep > 0 ? sweep - kTurn : sweep;
    }
    return sweep < 0 ? sweep + kTurn : sweep;
}

}  // namespace

std::array<unsigned, 3> axes_of(ArcPlane plane)
{
    switch (plane) {
        case ArcPlane::kXY:
            return {0, 1, 2};
        case ArcPlane::kZX:
            return {2, 0, 1};
        case ArcPlane::kYZ:
            break;
    }
    return {1, 2, 0};
}

ArcShape arc_shape(Vec3d start, const ArcTo& arc)
{
    const auto axes = axes_of(arc.plane);
    const double first = arc.centre[axes[0]];
    const double second = arc.centre[axes[1]];
    const Vec2d from{start[axes[0]] - first, start[axes[1]] - second};
    const Vec2d to{arc.end[axes[0]] - first, arc.end[axes[1]] - second};
    const double begin = elementary::atan2(from.y, from.x);
    const bool whole = norm(to - from) < kSamePoint;
    const double sweep = whole ? (arc.clockwise ? -kTurn : kTurn)
                               : swept(begin, elementary::atan2(to.y, to.x), arc.clockwise);
    return {axes, start, arc.end, first, second, begin, sweep, norm(from), norm(to)};
}

Vec3d point_on(const ArcShape& arc, double share)
{
    if (share <= 0) {
        return arc.start;
    }
    if (share >= 1) {
        return arc.end;
    }
    const double angle = arc.start_angle + share * arc.sweep;
    const double radius = arc.start_radius + share * (arc.end_radius - arc.start_radius);
    const double travel = arc.end[arc.axes[2]] - arc.start[arc.axes[2]];
    Vec3d p;
    p[arc.axes[0]] = arc.centre_first + radius * elementary::cos(angle);
    p[arc.axes[1]] = arc.centre_second + radius * elementary::sin(angle);
    p[arc.axes[2]] = arc.start[arc.axes[2]] + share * travel;
    return p;
}

Vec3d tangent_on(const ArcShape& arc, double share)
{
    const double angle = arc.start_angle + share * arc.sweep;
    const double radius = arc.start_radius + share * (arc.end_radius - arc.start_radius);
    Vec3d t;
    t[arc.axes[0]] = -radius * elementary::sin(angle) * arc.sweep;
    t[arc.axes[1]] = radius * elementary::cos(angle) * arc.sweep;
    t[arc.axes[2]] = arc.end[arc.axes[2]] - arc.start[arc.axes[2]];
    const double size = norm(t);
    return size > 0 ? t / size : t;
}

double length(const ArcShape& arc)
{
    const double round = (arc.start_radius + arc.end_radius) / 2 * std::abs(arc.sweep);
    return elementary::hypot(round, arc.end[arc.axes[2]] - arc.start[arc.axes[2]]);
}

}  // namespace cusp::toolpath
