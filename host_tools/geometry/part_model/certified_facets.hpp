// Triangles in place of trimmed surfaces, certified.
#pragma once

#include <array>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::part_model {

// Triangles that lie within `error` (mm > 0) of the surfaces, and the surfaces of them; at trims what a
// surface is beyond or short of its edges counts as well, but for the error of the polylines along them,
// a tenth of that.
//
// A cell of a patch is halved until the second derivatives, bounded by its control points, let its
// triangles be no farther off (Filip, Magedson & Markot 1986). A cell across an edge is the convex hull
// of what is inside, halved until that has no more than the error of the outside. Neighbouring triangles
// need not share corners: cracks are as wide as the error.
std::vector<std::array<Vec3d, 3>> certified_facets(const std::vector<nurbs::Surface>& surfaces,
                                                   double error);

}  // namespace cusp::part_model
