// Tessellates NURBS faces within the tolerance of trial balls.
#pragma once

#include <array>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::part_info {

struct SurfaceFacets {
    std::vector<std::array<Vec3d, 3>> triangles;  // none without area; neighbours meet within the
                                                  // tolerance, not always at corners
    double tolerance{};                           // mm, as achieved
};

// tolerance  mm, > 0: between triangles and surfaces; doubled until two million triangles suffice.
//            Trimmed edges are within five times that, concave corners of trims within 0.05 mm.
//
// PartModel's exact distances are too slow here: a ball that nearly fits a fillet is equally far
// from all of it, so that an exact search visits every cell. Facets are found in a grid.
SurfaceFacets surface_facets(const std::vector<nurbs::Surface>& surfaces, double tolerance);

}  // namespace cusp::part_info
