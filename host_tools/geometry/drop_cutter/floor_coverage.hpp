// True if a floor lies below a whole region.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::drop_cutter {

// A point of the region, its contours included, with no surface below it; none if none is found.
// Contours are sampled a tool radius apart. If the floor may have gaps, the area between them is
// sampled on a grid: a quarter radius apart at least, and at most 250 points a side. A single
// untrimmed surface that does not close on itself (as a ring does) has no gaps.
//
// surfaces  those of `floor`
// tool_radius  mm
std::optional<Vec2d> point_without_floor(const offset::Region2d& region,
                                         const DropCutter& floor,
                                         const std::vector<nurbs::Surface>& surfaces,
                                         double tool_radius);

}  // namespace cusp::drop_cutter
