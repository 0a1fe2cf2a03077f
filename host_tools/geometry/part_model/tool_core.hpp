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
// ball) and everything straight above. It is convex, so the squared distance from it is convex and
// smooth.
struct ToolCore {
    double radius;
    Vec3d end;

    // The vector from the nearest point of the core to `p`.
    Vec3d reach(Vec3d p) const
    {
        Vec3d r{p.x - end.x, p.y - end.y, std::min(0.0, p.z - end.z)};
        if (radius > 0) {
            const double away = elementary::hypot(r.x, r.y);
            const double left = away > radius ? (away - radius) / away : 0;
            r.x *= left;
            r.y *= left;
        }
        return r;
    }

    double distance_to_box(Vec3d low, Vec3d high) const
    {
        const double x = std::max({low.x - end.x, end.x - high.x, 0.0});
        const double y = std::max({low.y - end.y, end.y - high.y, 0.0});
        const double down = std::max(0.0, end.z - high.z);
        if (radius == 0) {
            return std::sqrt(x * x + y * y + down * down);
        }
        const double out = std::max(0.0, std::sqrt(x * x + y * y) - radius);
        return std::sqrt(out * out + down * down);
    }
};

ToolCore core_of(const toolpath::Tool& tool, Vec3d tip);

// A lower bound of the distance from the core to a cell.
double oriented_distance(const ToolCore& core, const BezierCell& cell);

// The distance from the core to a straight edge, and the edge's nearest point, `place`.
double edge_distance(const ToolCore& core, const std::array<Vec3d, 2>& edge, Vec3d& place);

}  // namespace cusp::part_model
