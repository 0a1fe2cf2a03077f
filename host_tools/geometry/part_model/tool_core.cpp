// Distances from boxes along tangent planes, and from edges: in closed form for a ball, by
// false position for other ends.
#include "host_tools/geometry/part_model/tool_core.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/bracketed_zero.hpp"

namespace cusp::part_model {

using toolpath::Tool;

namespace {

constexpr int kEdgeSteps = 80;
constexpr double kExactShare = 1e-13;  // of an edge

// The nearest point of a straight edge to the core of a ball, a point and everything above it: the
// nearest in space below that point, the nearest in plan above it.
double ball_edge_distance(const ToolCore& core, const std::array<Vec3d, 2>& edge, Vec3d& place)
{
    const Vec3d d = edge[1] - edge[0];
    const Vec3d from = core.end - edge[0];
    const double plan_square = d.x * d.x + d.y * d.y;
    const double along = from.x * d.x + from.y * d.y;
    const double rise = d.z * d.z;
    double t = 0;
    if (plan_square + rise > 0) {
        const double in_space = std::clamp((along + from.z * d.z) / (plan_square + rise), 0.0, 1.0);
        t = in_space;
        if (edge[0].z + t * d.z > core.end.z) {
            // The squared distance is convex and smooth: if its part below the core's end still
            // falls there, the minimum is above.
            const double seen = plan_square > 0 ? std::clamp(along / plan_square, 0.0, 1.0) : t;
            const double height = edge[0].z + seen * d.z;
            t = height >= core.end.z ? seen : from.z / d.z;
        }
    }
    place = edge[0] + d * t;
    return norm(core.reach(place));
}

}  // namespace

ToolCore core_of(const Tool& tool, Vec3d tip)
{
    const Vec3d end{tip.x, tip.y, tip.z + tool.corner_radius};
    if (!is_conical(tool)) {
        return {tool.radius - tool.corner_radius, end};
    }
    const double half = 0.5 * tool.tip_angle;
    return {tool.tip_radius, end, elementary::tan(half),
            tool.radius - tool.corner_radius * elementary::cos(half)};
}

// By the box along the tangent plane.
double oriented_distance(const ToolCore& core, const BezierCell& cell)
{
    const Vec3d from = core.end - cell.middle().point;
    const Vec3d normal = cell.axes()[0];
    const double tilt = core.radius > 0 ? core.radius * elementary::hypot(normal.x, normal.y) : 0;
    const double above = dot(from, normal) - tilt - cell.box_high(0);
    if (core.radius > 0 || cell.high().z > core.end.z) {
        return std::max(0.0, above);
    }
    const double gap = std::max({above, cell.box_low(0) - dot(from, normal), 0.0});
    double square = gap * gap;
    for (std::size_t k = 1; k < 3; ++k) {
        const double along = dot(from, cell.axes()[k]);
        const double outside = std::max({along - cell.box_high(k), cell.box_low(k) - along, 0.0});
        square += outside * outside;
    }
    return std::sqrt(square);
}

// The squared distance from the core is convex along the edge: its slope has one zero.
double edge_distance(const ToolCore& core, const std::array<Vec3d, 2>& edge, Vec3d& place)
{
    if (core.is_point()) {
        return ball_edge_distance(core, edge, place);
    }
    const Vec3d d = edge[1] - edge[0];
    const Bracket nearest = bracketed_zero({0, 1}, {kExactShare, kEdgeSteps}, [&](double share) {
        return -dot(core.reach(edge[0] + d * share), d);
    });
    place = edge[0] + d * nearest.low;
    return norm(core.reach(place));
}

}  // namespace cusp::part_model
