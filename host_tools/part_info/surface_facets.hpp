// NURBS faces as triangles, close enough to try balls on.
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

// tolerance  mm, > 0: between triangles and surfaces; doubled until fewer than two million will do.
//            Trimmed edges are kept to five of it, inner corners of trims to 0.05 mm.
//
// Why not PartModel's exact distances: a ball that nearly follows a hollow is as far from all of
// it, which takes an exact search through every cell. Facets are looked up.
SurfaceFacets surface_facets(const std::vector<nurbs::Surface>& surfaces, double tolerance);

}  // namespace cusp::part_info
