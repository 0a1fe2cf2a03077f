// All points near the edges of a region.
#pragma once

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::offset {

// The points no farther than `distance` (mm, > 0) from the contours, as contours that overlap: a
// disc about each corner and a band along each edge, all counter-clockwise.
Region2d edge_reach(const Region2d& region, double distance);

}  // namespace cusp::offset
