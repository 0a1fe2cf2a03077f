// Passes in parallel planes, equally spaced: what most CAM does, to compare with.
#pragma once

#include <vector>

#include "host_tools/import/job.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::host {

// Passes along x (direction "u") or y ("v") over the upper side of all surfaces, `step_over` apart;
// without it as far apart as the place that needs most allows for `scallop`. Proved free of gouges
// as `plan_adaptive_isocurve`; scallop_bound_mm is 0 (not computed) where step_over is given.
//
// Errors: InputError as `SurfaceOperation`; neither step_over nor scallop given.
std::vector<PlannedOperation> plan_parallel_planes(const Job& job, const Operation& operation);

}  // namespace cusp::host
