// Pencil passes as detours out of a loop and back: no retract, and no entry beside a wall of stock.
#pragma once

#include <vector>

#include "host_tools/clearing/clearing.hpp"
#include "host_tools/offset/offset.hpp"

namespace cusp::contour_pocket {

// Adds each pencil pass to the loop that it comes nearest to. Of several loops within a tenth of
// the tool's radius that is the one cut last, so that the stock beside is cut. The loop is divided
// there, and the detour lies between its parts (PassStart::kContinue). Returns the pencil passes
// that have no loop within the radius.
//
//   wall_clearance  mm: distance of the tool's axis from the contours on its way out
std::vector<clearing::ClearingPass> add_pencil_detours(
    clearing::ClearedRegion& cleared,
    const std::vector<clearing::ClearingPass>& pencils,
    const offset::RegionOffset& walls,
    double wall_clearance,
    double radius);

// Adds the pencil passes behind the last pass in their part of `reach`, so that links to them cross
// stock that is cut.
//
//   reach  where the tool's axis may be: the offset of the walls that holds all passes
void add_pencil_passes(clearing::ClearedRegion& cleared,
                       const std::vector<clearing::ClearingPass>& pencils,
                       const offset::Region2d& reach);

}  // namespace cusp::contour_pocket
