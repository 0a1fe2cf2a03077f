// Finishing along sections of the part: vertical planes where it is shallow, levels where it is steep.
//
//     operation.strategy = &steep_shallow::kSteepShallow;   // or kWaterline, kParallelPlanes
//     operation.tolerance.scallop = 0.02;                   // mm
//     for (const auto& planned : plan_steep_shallow(job, operation)) { ... }
//
// A section of the drop surface is a pass: its curve in a plane (parallel_planes.hpp), or in a level
// (level_curves.hpp, level_passes.hpp). SectionStep says how far apart they may be. FinishCompletion
// proves what they leave, and adds the passes that are missing: in creases, between slopes.
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::steep_shallow {

// The records of the strategies; that of planes is in parallel_planes.hpp.
extern const job::Strategy kWaterline;
extern const job::Strategy kSteepShallow;

// Level loops over ground from 30 degrees on, or over that of `slopes`, as far apart as the scallop
// allows; `spiral` makes one way down of loops above each other. The scallop is proved over that ground,
// and passes are added where levels leave more.
//
// Errors: InputError as `SurfaceOperation`; no scallop; more than 20 000 levels.
std::vector<toolpath::PlannedOperation> plan_waterline(const job::Job& job,
                                                       const job::Operation& operation);

// Levels over ground from `steep_from` on, planes over the rest; either goes a stepover beyond that. One
// scallop is proved over all.
//
// Errors: InputError as `plan_waterline` and `plan_parallel_planes`.
std::vector<toolpath::PlannedOperation> plan_steep_shallow(const job::Job& job,
                                                           const job::Operation& operation);

}  // namespace cusp::steep_shallow
