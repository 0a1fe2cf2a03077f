// Whether a floor lies under all of a region.
#pragma once

#include <optional>

#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::host {

// A place of the region, its contours included, that no surface lies under; nothing where none was
// found. Contours are looked at a tool radius apart; with `inside` also the places between them, at
// least a quarter radius apart and at most 250 a side. One whole surface that lies under all
// contours lies under what is between: `inside` is for several ones, or trims.
std::optional<Vec2d> uncovered_place(const Region2d& region,
                                     const TipFloor& floor,
                                     double tool_radius,
                                     bool inside);

}  // namespace cusp::host
