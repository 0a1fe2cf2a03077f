// Distance of the stock's top from the material under and beside it.
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/judge/verify/height_grid.hpp"

namespace cusp::verify {

// mm from the stock's top at a grid point to the nearest column of material; at most max_distance.
// Too high by up to the distance of neighbouring columns. A sliver beside a wall is high
// and yet no farther from the wall than it is thick; the crest between two passes is as far from the
// floor as it is high along the normal.
//
// heights       mm: top of the material that stays; not finite where there is none
// top           mm: height of the stock at the point
// max_distance  mm: the height of the stock along the normal
// sufficient    mm: results up to this may be too high
double stock_distance(const HeightGrid& grid,
                      const std::vector<double>& heights,
                      std::size_t point,
                      double top,
                      double max_distance,
                      double sufficient);

}  // namespace cusp::verify
