// Finishing with a ball along adaptive isocurves of trimmed NURBS surfaces (Elber & Cohen), and
// along complete isocurves for comparison.
//
//     job::Operation operation = job.operations.front();  // floor: surfaces; tool: a ball
//     operation.scallop = 0.02;                           // mm; or iso_distance
//     for (const toolpath::PlannedOperation& planned : plan_adaptive_isocurve(job, operation)) {
//         planned.stats.gouge_bound_mm;                   // 0: proved free of gouges
//         planned.stats.scallop_bound_mm;                 // proved bound, tolerance included
//     }
//
// The way of a surface through this module: IsocurveSelection chooses curves in its domain, by
// iso_distance (isocurve_extraction.hpp) or by scallop (equal_scallop_passes.hpp).
// OffsetCurveTrimmer maps them to the offset surface and trims them by the rest of the model.
// SurfaceOperation fits, links and reports the passes. finishing::ScallopCheck proves the scallop
// and adds missing passes. plan_waterline_roughing() comes first if the job has roughing.
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/finish_keys.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::adaptive_isocurve {

// The records of the strategies.
extern const job::Strategy kAdaptiveIsocurve;
extern const job::Strategy kCompleteIsocurves;

// Finishes the upper side of the operation's surfaces with a ball.
//
// With iso_distance: sub-isocurves by the paper's rule, neighbours within that distance of each
// other. With scallop: passes a full stepover apart by the curvature across them, together about a
// third shorter (`equal_scallop_passes`). scallop_bound_mm includes the tolerance.
//
// The passes of a surface lie on its offset and end where the tool would touch anything else. A
// pass follows that edge. The whole path, links included, is proved free of gouges: gouge_bound_mm
// is 0 unless tolerance_side = "both".
// Source: Elber & Cohen 1993; docs/papers.md lists departures from it.
//
// Walls beside which a ball would rest on nothing are not claimed: the count walls_over_nothing_mm.
//
// With roughing = true the operations of `plan_waterline_roughing` come first, one for each tool.
//
// Errors: InputError as `SurfaceOperation` and `plan_waterline_roughing`; neither iso_distance nor
// scallop given; no part of the surfaces reachable by the tool.
std::vector<toolpath::PlannedOperation> plan_adaptive_isocurve(const job::Job& job,
                                                               const job::Operation& operation);

// As plan_adaptive_isocurve() with complete isocurves, equally spaced in the parameter: within
// iso_distance, or within the distance that the worst point requires for the scallop.
std::vector<toolpath::PlannedOperation> plan_complete_isocurves(const job::Job& job,
                                                                const job::Operation& operation);

}  // namespace cusp::adaptive_isocurve
