// Whether a floor lies under all of a region.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::host {

// A place of the region, its contours included, that no surface lies under; nothing where none was
// found. Contours are looked at a tool radius apart; the places between them, at least a quarter
// radius apart and at most 250 a side, where the floor may have gaps: one whole surface that does
// not close on itself (a ring does) and lies under all contours lies under what is between.
//
// surfaces  those of `floor`
std::optional<Vec2d> uncovered_place(const Region2d& region,
                                     const TipFloor& floor,
                                     const std::vector<Surface>& surfaces,
                                     double tool_radius);

}  // namespace cusp::host
