// Pencil passes as detours from a loop and back: no retract, and no entry beside a wall of stock.
#pragma once

#include <vector>

#include "host_tools/cam/clearing/clearing.hpp"
#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::contour_pocket {

// Adds each pencil pass to the nearest loop. If several loops lie within a tenth of the tool's
// radius, the one cut last is taken, so the stock beside it is already cut. The loop is divided
// there, and the detour lies between its parts (PassStart::kContinue). Returns the pencil passes
// without a loop within the radius.
//
// wall_clearance  mm: distance of the tool's axis from the contours on the detour
std::vector<clearing::ClearingPass> add_pencil_detours(
    clearing::ClearedRegion& cleared,
    const std::vector<clearing::ClearingPass>& pencils,
    const offset::RegionOffset& walls,
    double wall_clearance,
    double radius);

// Adds the pencil passes after the last pass in their part of `reach`, so that links to them cross
// material that is already cut.
//
// reach  where the tool's axis may be: the offset of the walls that contains all passes
void add_pencil_passes(clearing::ClearedRegion& cleared,
                       const std::vector<clearing::ClearingPass>& pencils,
                       const offset::Region2d& reach);

}  // namespace cusp::contour_pocket
