// NURBS faces as triangles, within the tolerance of trial balls.
#pragma once

#include <array>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::part_info {

struct SurfaceFacets {
    std::vector<std::array<Vec3d, 3>> triangles;  // none without area; neighbours may not meet in
                                                  // corners, but within the tolerance
    double tolerance{};                           // mm, that was kept
};

// tolerance  mm, > 0: between triangles and surfaces; doubled until fewer than two million suffice.
//            Trimmed edges keep to five times that, inner corners of trims to 0.05 mm.
//
// PartModel's exact distances are too slow here: a ball that nearly fits a hollow is equally far
// from all of it, so an exact search visits every cell. Facets are looked up.
SurfaceFacets surface_facets(const std::vector<nurbs::Surface>& surfaces, double tolerance);

}  // namespace cusp::part_info
