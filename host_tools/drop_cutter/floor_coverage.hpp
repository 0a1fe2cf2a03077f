// Whether a floor lies under all of a region.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/drop_cutter/drop_cutter.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::drop_cutter {

// A place of the region, its contours included, that no surface lies under; nothing where none was
// found. Contours are looked at a tool radius apart; the places between them, at least a quarter
// radius apart and at most 250 a side, where the floor may have gaps: one whole surface that does
// not close on itself (a ring does) and lies under all contours lies under what is between.
//
// surfaces  those of `floor`
std::optional<Vec2d> point_without_floor(const offset::Region2d& region,
                                         const DropCutter& floor,
                                         const std::vector<nurbs::Surface>& surfaces,
                                         double tool_radius);

}  // namespace cusp::drop_cutter
