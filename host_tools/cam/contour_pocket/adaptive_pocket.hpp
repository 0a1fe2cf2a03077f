// Clears a pocket with a level floor by passes of bounded engagement, layer by layer.
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::contour_pocket {

// Plans an operation with clearing = "adaptive". All layers have the same passes; the last one is
// on the floor, and nothing is left for a finish.
//
// Errors: InputError as plan_contour_pocket(), and for a floor that is not level.
std::vector<toolpath::PlannedOperation> plan_adaptive_pocket(const job::Job& job,
                                                             const job::Operation& operation);

}  // namespace cusp::contour_pocket
