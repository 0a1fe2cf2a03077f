// Where a function over a surface's domain is not negative, outlined by loops in (u, v).
#pragma once

#include <vector>

#include "host_tools/nurbs/nurbs.hpp"
#include "host_tools/part_model/contour_lattice.hpp"

namespace cusp::part_model {

// Half a millimetre apart, but at least 24 and at most 128.
DomainSamples samples_over(const nurbs::Surface& surface);

// Closed polylines, the place outlined to their left; the last point is the first one again.
//
// edge_error  mm > 0: how far their sides may lie from the outline, on the surface, as probed at
//             their middles. What is left of a corner is as much.
//
// Looks at a lattice (marching squares), which is halved at least twice, and on as long as that
// tells something new, down to some 2000 looks along each side: narrower pieces that the looks do
// not hint at are missed.
std::vector<std::vector<Vec2d>> domain_contour(const nurbs::Surface& surface,
                                               const DomainMargin& margin,
                                               double edge_error);

}  // namespace cusp::part_model
