// The contour, by loops in (u, v), of the part of a surface's domain where a function is >= 0.
#pragma once

#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/part_model/contour_lattice.hpp"

namespace cusp::part_model {

// Samples half a millimetre apart, at least 24 and at most 128 along u and v.
DomainSamples samples_over(const nurbs::Surface& surface);

// Closed polylines with the inside to their left; the last point repeats the first.
//
// edge_error  mm > 0: maximum distance between the polyline and the contour on the surface, as
//             probed at the middles of sides; also how much of a corner may be cut off
//
// Marching squares on a lattice, which is halved at least twice, and again as long as this finds
// something new, down to some 2000 samples along each side. Parts narrower than that are missed if
// no sample hits them.
std::vector<std::vector<Vec2d>> domain_contour(const nurbs::Surface& surface,
                                               const DomainMargin& margin,
                                               double edge_error);

}  // namespace cusp::part_model
