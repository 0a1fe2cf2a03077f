// Layered roughing of B-spline surfaces under their convex hull boxes, after Chuang & Pan.
//
//     const std::vector<toolpath::PlannedOperation> planned = plan_hull_rough(job, operation);
//     planned.front().path.moves;            // of the tool's tip
//     planned.front().stats.counts;            // layers, patches, boxes
//
// The surfaces become Bezier patches by knot insertion; each patch lies in the box of its control
// points. Tops of boxes divide the stock into layers; in each layer the boxes that reach above its
// bottom are islands, and the rest is cleared like a pocket, so no surface is ever cut into.
// With `extra_subdivision` the same hull bound is used finer: patches that cross the layer's bottom
// are quartered, what counts of a hull is its part above the bottom, and the layers lie where least
// is left.
#pragma once

#include <vector>

#include "host_tools/job/job.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::hull_rough {

// Plans the operation: one result for each run of layers with the same cutter, from the top down.
// Reports layers, patches, boxes, islands and what the choice of cutters saves.
//
// Errors: InputError where a limit of depth, the overlap, the output form or the cutters can't be
// used. Source: Chuang & Pan, "Rough cut tool path planning for B-spline surfaces using convex hull
// boxes".
std::vector<toolpath::PlannedOperation> plan_hull_rough(const job::Job& job,
                                                        const job::Operation& operation);

}  // namespace cusp::hull_rough
