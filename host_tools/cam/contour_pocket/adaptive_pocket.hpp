// Clears a pocket with a level floor by passes of bounded engagement, layer by layer.
#pragma once

#include <vector>

#include "host_tools/cam/contour_pocket/pocket_task.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::contour_pocket {

// Plans a pocket with clearing = "adaptive"; where it is open its region grows by the air beside the
// stock. All layers have the same passes; the last one is on the floor, and nothing is left for a
// finish.
//
// Precondition: the floor is level (job/level_floor.hpp).
//
// Errors: InputError as plan_contour_pocket().
std::vector<toolpath::PlannedOperation> plan_adaptive_pocket(Pocket pocket);

// Errors: InputError if the region is too large for the areas that adaptive clearing keeps with the
// operation's tool.
void check_adaptive_size(const job::Operation& operation, const offset::Region2d& region);

}  // namespace cusp::contour_pocket
