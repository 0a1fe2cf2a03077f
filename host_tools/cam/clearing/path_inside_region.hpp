// A path between any two points of a region.
#pragma once

#include <vector>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::clearing {

// Straight from one point to the other; where that leaves the region, along the contour in the
// shorter direction. Empty if no part of the region contains both points, or they are equal.
std::vector<offset::Edge> path_inside_region(const offset::Region2d& region, Vec2d from, Vec2d to);

}  // namespace cusp::clearing
