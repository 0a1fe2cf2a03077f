// More knots where a surface turns far within one span. Planners bound a surface by its Bezier
// patches. A patch that turns by a quarter of a circle, as in CAD files, gives a loose bound: each
// search for the nearest place would halve it again and again.
#pragma once

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

// Returns the surface with more knots: between two of them the normal turns by about 15 degrees at
// most along each parameter, or the span has reached the limit of halvings.
nurbs::Surface with_turning_knots(const nurbs::Surface& surface);

}  // namespace cusp::import
