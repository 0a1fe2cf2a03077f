// Finishing in equally spaced parallel planes: the usual strategy of CAM.
#pragma once

#include <vector>

#include "host_tools/cam/steep_shallow/finish_completion.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::steep_shallow {

// The record of the strategy.
extern const job::Strategy kParallelPlanes;

// Passes along x (direction "u") or y ("v"), turned by `angle`, over the upper side of all surfaces or of
// a mesh, and beyond rims that the tool overhangs. They are `step_over` apart, or as far as `scallop`
// allows at the most demanding point; ground steeper than 75 degrees across the planes does not count.
// They end where the operation's area ends (FinishArea). Proved free of gouges as by
// `plan_adaptive_isocurve`.
//
// With `scallop` alone, passes are added where the planes leave more, as `ScallopCheck` and
// `MeshCheck` find; scallop_bound_mm is what they prove. With `step_over` none are added, and
// it is a bound of what the planes leave, at most the tool's radius.
//
// Errors: InputError as `SurfaceOperation`; neither step_over nor scallop given; more than 20 000
// planes.
std::vector<toolpath::PlannedOperation> plan_parallel_planes(const job::Job& job,
                                                             const job::Operation& operation);

// The planes alone.
//
// area  where they run, with a step beyond its border
// Returns the distance between planes, mm.
double cut_planes(const job::Job& job,
                  const job::Operation& operation,
                  const finishing::SurfaceOperation& work,
                  const finishing::FinishArea& area,
                  FinishCompletion& passes);

}  // namespace cusp::steep_shallow
