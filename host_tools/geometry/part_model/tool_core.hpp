// The core of a tool, its shape without the corner radius, and its distance from points, boxes,
// edges and cells.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/bezier_cell.hpp"
#include "host_tools/geometry/toolpath/tool.hpp"

namespace cusp::part_model {

// The tool offset inward by its corner radius: a disc of radius `radius` at `end` (a point for a
// ball), a cone that widens upward from its rim, and a cylinder above that; and everything straight
// above. It is convex, so the squared distance from it is convex and smooth.
struct ToolCore {
    double radius;
    Vec3d end;
    double widening{0};  // tangent of half the angle between the flanks; 0: there is no cone
    double widest{0};    // mm: radius of the cylinder above a cone

    bool is_point() const { return radius == 0 && widening == 0; }
    double greatest_radius() const { return widening > 0 ? widest : radius; }
    // mm over the end: where the cone goes over into the cylinder.
    double cone_height() const { return widening > 0 ? (widest - radius) / widening : 0; }

    // The vector from the nearest point of the core to one in a plane through the axis: `away` from
    // the axis, `up` over the end.
    struct Gap {
        double out;
        double up;
    };
    Gap gap(double away, double up) const
    {
        if (widening == 0) {
            return {std::max(0.0, away - radius), std::min(0.0, up)};
        }
        if (up >= 0 && away <= std::min(widest, radius + widening * up)) {
            return {0, 0};
        }
        // mm of height, of the nearest point of the flank's line.
        const double height = ((away - radius) * widening + up) / (1 + widening * widening);
        if (height <= 0) {
            return {std::max(0.0, away - radius), std::min(0.0, up)};
        }
        const double top = cone_height();
        if (height >= top) {
            return {std::max(0.0, away - widest), std::min(0.0, up - top)};
        }
        return {away - radius - widening * height, up - height};
    }

    // The vector from the nearest point of the core to `p`.
    Vec3d reach(Vec3d p) const
    {
        Vec3d r{p.x - end.x, p.y - end.y, std::min(0.0, p.z - end.z)};
        if (!is_point()) {
            const double away = elementary::hypot(r.x, r.y);
            const Gap rest = gap(away, p.z - end.z);
            const double left = away > 0 ? rest.out / away : 0;
            r = {r.x * left, r.y * left, rest.up};
        }
        return r;
    }

    double distance_to_box(Vec3d low, Vec3d high) const
    {
        const double x = std::max({low.x - end.x, end.x - high.x, 0.0});
        const double y = std::max({low.y - end.y, end.y - high.y, 0.0});
        if (is_point()) {
            const double down = std::max(0.0, end.z - high.z);
            return std::sqrt(x * x + y * y + down * down);
        }
        // The distance falls with the height and rises with the distance from the axis.
        const Gap rest = gap(std::sqrt(x * x + y * y), high.z - end.z);
        return std::sqrt(rest.out * rest.out + rest.up * rest.up);
    }

    // The point of the core farthest against an upward vector: a plane with that normal touches there
    // first. Of several one.
    Vec3d farthest_against(Vec3d normal) const
    {
        const double tilt = elementary::hypot(normal.x, normal.y);
        if (tilt == 0 || is_point()) {
            return end;
        }
        const bool top = tilt * widening > normal.z;
        const double out = (top ? widest : radius) / tilt;
        return end + Vec3d{-normal.x * out, -normal.y * out, top ? cone_height() : 0};
    }
};

// Of a cone's flank the core reaches a little beyond the tool at the upper end, never less: by the corner
// radius times (1 - cosine of half the angle).
ToolCore core_of(const toolpath::Tool& tool, Vec3d tip);

// A lower bound of the distance from the core to a cell.
double oriented_distance(const ToolCore& core, const BezierCell& cell);

// The distance from the core to a straight edge, and the edge's nearest point, `place`.
double edge_distance(const ToolCore& core, const std::array<Vec3d, 2>& edge, Vec3d& place);

}  // namespace cusp::part_model
