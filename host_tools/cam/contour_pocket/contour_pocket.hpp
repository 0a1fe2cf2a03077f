// Contour-parallel pocketing with a sculptured floor, after Suh & Lee (1990): offset loops of the
// boundary and the islands, CL points from the floor, the paper's order of passes.
//
//     const std::vector<toolpath::PlannedOperation> planned = plan_contour_pocket(job, operation);
//     planned.front().path.moves;              // of the tool's tip
//     planned.front().stats.scallop_bound_mm;  // upper bound of the scallop left
//
// Departures from the paper and their reasons are in docs/papers.md.
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::contour_pocket {

// The records of the pocket over a floor, and of the pocket down to a level, which starts at its own top.
extern const job::Strategy kContourPocket;
extern const job::Strategy kPocket;

// Plans the operation. With tolerance_side "outside" the path is never below the floor and never
// passes through a wall: each move has a computed lower bound of its clearance from the floor.
//
// Errors: InputError for a missing boundary or floor, crossing contours, a tool too large for the
// pocket, tolerances out of range, and a floor that does not cover the pocket.
std::vector<toolpath::PlannedOperation> plan_contour_pocket(const job::Job& job,
                                                            const job::Operation& operation);

}  // namespace cusp::contour_pocket
