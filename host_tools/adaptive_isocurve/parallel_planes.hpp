// Passes in parallel planes, equally spaced: what most CAM does, to compare with.
#pragma once

#include <vector>

#include "host_tools/job/job.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::adaptive_isocurve {

// Passes along x (direction "u") or y ("v") over the upper side of all surfaces, or of a mesh, and
// beyond its rims where the ball stands there; `step_over` apart, without it as far apart as the
// place that needs most allows for `scallop`. Ground that falls off by more than 75 degrees across
// the planes does not count. Proved free of gouges as `plan_adaptive_isocurve`; scallop_bound_mm is
// the scallop where cells of the surfaces prove it, else the tool's radius, with a warning.
//
// Errors: InputError as `SurfaceOperation`; neither step_over nor scallop given; more than 20 000
// planes.
std::vector<toolpath::PlannedOperation> plan_parallel_planes(const job::Job& job,
                                                             const job::Operation& operation);

}  // namespace cusp::adaptive_isocurve
