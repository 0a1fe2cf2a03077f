// Elber and Cohen's adaptive isocurves for models of trimmed NURBS surfaces, and what they are
// compared with: complete isocurves.
//
//     const std::vector<toolpath::PlannedOperation> planned = plan_adaptive_isocurve(job, operation);
//     planned.front().path.moves;            // of the tool's tip
//     planned.front().stats.scallop_bound_mm;  // what may be left, at most
#pragma once

#include <vector>

#include "host_tools/job/job.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::adaptive_isocurve {

// Finishes the upper side of the operation's surfaces with a ball.
//
// With iso_distance: sub-isocurves by the paper's rule, neighbours within that distance of each
// other. With scallop: passes a full step apart by the curvature across them, shorter by about a
// third (`equal_scallop_passes`); the ridges are measured at every node of the plan and counted
// into scallop_bound_mm, the tolerance included.
//
// Each surface's passes lie on its offset and end where the tool would touch anything else; a pass
// follows that edge. The whole path, links included, is proved to keep the tool out of all
// surfaces: gouge_bound_mm is 0 unless tolerance_side = "both".
// Source: Elber & Cohen 1993; docs/papers.md says where this departs from it.
//
// With roughing = true the layers of `plan_waterline_roughing` come first, an operation for each
// tool.
//
// Errors: InputError as `SurfaceOperation` and `plan_waterline_roughing`; neither iso_distance nor
// scallop given; nothing of the surfaces in the tool's reach.
std::vector<toolpath::PlannedOperation> plan_adaptive_isocurve(const job::Job& job,
                                                               const job::Operation& operation);

// The same with complete isocurves, equally spaced in the parameter, within iso_distance (or for
// scallop, the distance that the worst place needs).
std::vector<toolpath::PlannedOperation> plan_complete_isocurves(const job::Job& job,
                                                                const job::Operation& operation);

}  // namespace cusp::adaptive_isocurve
