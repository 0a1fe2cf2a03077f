// More knots where a surface turns far within one span. Planners bound a surface by its Bezier
// patches, and a patch that turns a quarter of a circle, as CAD files have them, bounds little: a
// search for the nearest place would cut it over and over.
#pragma once

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::host {

// The same surface; between two knots its normal turns by about 15 degrees at most along each
// parameter, or the span has been cut as often as makes sense.
Surface with_turning_knots(const Surface& surface);

}  // namespace cusp::host
