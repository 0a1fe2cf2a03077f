// Triangles as they are: how far a tool keeps from one, and how a ball comes to rest on one.
#pragma once

#include <array>
#include <optional>

#include "host_tools/part_model/tool_core.hpp"

namespace cusp::part_model {

struct Facet {
    // corners  not all on a line
    explicit Facet(const std::array<Vec3d, 3>& corners);

    // Whether a point of its plane lies in it, sides included.
    bool holds(Vec3d in_plane) const;

    std::array<Vec3d, 3> corners;
    Vec3d normal;  // unit, never downward
};

// Distance from the core of a tool to a facet and the nearest point of it, `place`. Exact for a
// ball; for a disc as `edge_distance`.
//
// Both are convex: where the way to the facet's plane ends in the facet nothing of it is nearer,
// else its sides are.
double facet_distance(const ToolCore& core, const Facet& facet, Vec3d& place);

struct FacetContact {
    double centre;  // mm: height of the ball's centre
    Vec3d point;
};

// A ball dropped at (x, y) on one facet; none where it passes beside it, or
// where its centre would be below `least`.
std::optional<FacetContact> drop_ball_on_facet(
    const Facet& facet, double x, double y, double radius, double least);

// Height of the facet at (x, y); none beside it, or where it stands upright.
std::optional<double> height_at(const Facet& facet, double x, double y);

}  // namespace cusp::part_model
