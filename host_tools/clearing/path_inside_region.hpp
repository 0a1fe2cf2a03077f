// A way between any two places of a region.
#pragma once

#include <vector>

#include "host_tools/offset/contour.hpp"

namespace cusp::clearing {

// Straight from one place to the other and, where that leaves the region, along the contour there,
// the shorter way round. Empty where no part of the region has both places, or they are one.
std::vector<offset::Edge> path_inside_region(const offset::Region2d& region, Vec2d from, Vec2d to);

}  // namespace cusp::clearing
