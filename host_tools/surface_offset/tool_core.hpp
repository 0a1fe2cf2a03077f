// A tool without its corner radius, and how far it is from points, boxes, edges and cells.
#pragma once

#include <array>

#include "host_tools/surface_offset/bezier_cell.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::host {

// What is left of a tool when its corner radius is taken off all round: a disc of radius `radius`
// at `end` (a point for a ball) and everything straight above it. It is convex, so the square of
// the distance to it is convex and smooth.
struct ToolCore {
    double radius;
    Vec3d end;

    // From the nearest point of the core to `p`.
    Vec3d reach(Vec3d p) const;
    double distance_to_box(Vec3d low, Vec3d high) const;
};

ToolCore core_of(const Tool& tool, Vec3d tip);

// A lower bound of the distance from the core to a cell.
double oriented_distance(const ToolCore& core, const BezierCell& cell);

// Distance to a straight edge and its nearest point, `place`.
double edge_distance(const ToolCore& core, const std::array<Vec3d, 2>& edge, Vec3d& place);

}  // namespace cusp::host
