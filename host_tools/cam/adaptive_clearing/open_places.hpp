// Ground without stock from which passes start: beside the stock, or where another tool has been.
#pragma once

#include <vector>

#include "host_tools/cam/adaptive_clearing/swept_area.hpp"
#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::adaptive_clearing {

// Adds all that the tool reaches with its centre in the regions to the swept area. Returns places
// on their contours, a tenth of the radius apart.
std::vector<Vec2d> sweep_open(SweptArea& swept, const std::vector<offset::Region2d>& open);

}  // namespace cusp::adaptive_clearing
