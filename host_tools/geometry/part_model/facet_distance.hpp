// Triangles, and the distance of a tool from one.
#pragma once

#include <array>
#include <optional>

#include "host_tools/geometry/part_model/tool_core.hpp"

namespace cusp::part_model {

struct Facet {
    // corners  not all on a line
    explicit Facet(const std::array<Vec3d, 3>& corners);

    // True if a point of its plane lies in it, sides included.
    bool holds(Vec3d in_plane) const;

    std::array<Vec3d, 3> corners;
    Vec3d normal;  // unit, never downward
};

// Distance from the core of a tool to a facet, and the nearest point of the facet, `place`. Exact
// for a ball; for other ends as accurate as edge_distance().
//
// Both are convex. If the nearest point of the facet's plane lies in the facet, it is the nearest
// point; otherwise that is on a side.
//
// limit  mm: where the distance is proved to be at least this, some number not below it is returned,
//        and no place
double facet_distance(const ToolCore& core,
                      const Facet& facet,
                      Vec3d& place,
                      double limit = kInfinite);

// Height of the facet at (x, y); none beside it, or where it is vertical.
std::optional<double> height_at(const Facet& facet, double x, double y);

}  // namespace cusp::part_model
