// Distances of all points of a grid from marked ones.
#pragma once

#include <vector>

#include "host_tools/judge/verify/height_grid.hpp"

namespace cusp::verify {

// mm from each point to the nearest marked one, shifts of the grid left out: wrong by up to a
// pitch. kUnbounded where none is marked. After Felzenszwalb and Huttenlocher, Distance Transforms
// of Sampled Functions, 2012: O(points).
std::vector<double> distances_from(const std::vector<char>& marked, const HeightGrid& grid);

}  // namespace cusp::verify
