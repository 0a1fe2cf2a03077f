// Inserts knots where the normal turns far within one span. Planners bound a surface by its Bezier
// patches. A patch that turns by a quarter of a circle, as in CAD files, has a loose bound, so that
// every closest-point query would have to subdivide it repeatedly.
#pragma once

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::import {

// Returns the surface with more knots. Between two of them the normal turns by at most about 15
// degrees along each parameter, unless the limit of subdivisions is reached.
nurbs::Surface with_turning_knots(const nurbs::Surface& surface);

}  // namespace cusp::import
