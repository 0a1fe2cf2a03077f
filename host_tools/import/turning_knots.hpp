// More knots where a surface turns far within one span. Planners bound a surface by its Bezier
// patches, and a patch that turns a quarter of a circle, as CAD files have them, bounds little: a
// search for the nearest place would cut it over and over.
#pragma once

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

// The same surface; between two knots its normal turns by about 15 degrees at most along each
// parameter, or the span has been cut as often as makes sense.
nurbs::Surface with_turning_knots(const nurbs::Surface& surface);

}  // namespace cusp::import
