// Passes along cliffs as ways out of a loop and back to it: no retract, and no slope down beside a
// wall of metal.
#pragma once

#include <vector>

#include "host_tools/clearing/clearing.hpp"

namespace cusp::host {

// Adds the passes where they come nearest to one that is cut then: of the places within a tenth of
// the tool's radius the one that is cut last, so that what lies beside is cut. That pass is divided
// there, and the way out and back lies between its parts (PassStart::kHere). What has no pass
// within the radius comes last, by itself.
//
//   least  mm: distance of the tool's axis from the contours on its way out
void add_cliff_detours(ClearedRegion& cleared,
                       const std::vector<ClearingPass>& cliffs,
                       const RegionOffset& walls,
                       double least,
                       double radius);

}  // namespace cusp::host
