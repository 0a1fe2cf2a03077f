// Contour-parallel pocketing with a sculptured floor, after Suh & Lee (1990): offset loops of the
// boundary and the islands, tool points from the floor, the paper's order.
//
//     const std::vector<toolpath::PlannedOperation> planned = plan_contour_pocket(job, operation);
//     planned.front().path.moves;            // of the tool's tip
//     planned.front().stats.scallop_bound_mm;  // what may be left, at most
//
// What is done differently, and why, is listed in docs/papers.md.
#pragma once

#include <vector>

#include "host_tools/job/job.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::contour_pocket {

// Plans the operation. With tolerance_side "outside" the path never lies below the floor or through
// a wall: every straight move carries a computed lower bound of its gap to the floor.
//
// Throws InputError for a missing boundary or floor, crossing contours, a tool too large for the
// pocket, tolerances out of range and a floor that does not cover the pocket.
std::vector<toolpath::PlannedOperation> plan_contour_pocket(const job::Job& job,
                                                            const job::Operation& operation);

}  // namespace cusp::contour_pocket
