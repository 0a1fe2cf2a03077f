// Passes along cliffs as ways out of a loop and back to it: no retract, and no slope down beside a
// wall of metal.
#pragma once

#include <vector>

#include "host_tools/clearing/clearing.hpp"
#include "host_tools/offset/offset.hpp"

namespace cusp::contour_pocket {

// Adds the passes where they come nearest to one that is cut then: of the places within a tenth of
// the tool's radius the one that is cut last, so that what lies beside is cut. That pass is divided
// there, and the way out and back lies between its parts (PassStart::kHere). Returns what has no
// pass within the radius.
//
//   wall_clearance  mm: distance of the tool's axis from the contours on its way out
std::vector<clearing::ClearingPass> add_pencil_detours(
    clearing::ClearedRegion& cleared,
    const std::vector<clearing::ClearingPass>& pencils,
    const offset::RegionOffset& walls,
    double wall_clearance,
    double radius);

// Adds the passes by themselves behind the last pass in their part of `reach`, so that there is a
// way to them over metal that is cut.
//
//   reach  of the tool's axis: the walls' offset that has all passes inside
void add_pencil_passes(clearing::ClearedRegion& cleared,
                       const std::vector<clearing::ClearingPass>& pencils,
                       const offset::Region2d& reach);

}  // namespace cusp::contour_pocket
