// Roughing of B-spline surfaces in layers, around their convex hull boxes (Chuang & Pan).
//
//     job::Operation operation = job.operations.front();  // floor: surfaces; tools of any shape
//     operation.max_depth = 3.0;                           // mm
//     for (const toolpath::PlannedOperation& planned : plan_hull_rough(job, operation)) {
//         planned.path.tool;                               // one result per run of equal cutters
//         planned.stats.counts;                            // layers, patches, boxes, islands
//     }
//
// Method. Surfaces become Bezier patches by knot insertion; each patch lies in the box of its
// control points (hull_patch.hpp). The tops of boxes divide the stock into layers
// (depth_layers.hpp). In each layer the boxes that reach above its bottom are islands, and the rest
// is cleared like a pocket (layer_clearing.hpp), so no surface is gouged. Cutters are chosen layer
// by layer (tool_choice.hpp). With `extra_subdivision` the bound is refined: patches that cross the
// bottom of the layer are quartered, only the part of a hull above the bottom counts, and planes
// are where the least stock is left.
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::hull_rough {

// The record of the strategy.
extern const job::Strategy kHullRough;

// Keys that it alone takes.
struct HullKeys {
    double overlap{};         // mm, of neighbouring passes
    int extra_subdivision{};  // halvings of patches
    bool contour_clearing{};  // in place of lines
};

// The operation's own keys.
template <class AnyOperation>
decltype(auto) hull_keys(AnyOperation& operation)
{
    return job::parameters_of<HullKeys>(operation);
}

// Plans the operation: one result for each run of layers with the same cutter, from the top down.
// Reports layers, patches, boxes, islands and the time that the choice of cutters saves. If nothing
// is to be roughed, it returns one result without moves.
//
// Errors: InputError where a depth limit, the overlap, the output form or the cutters cannot be
// used. Source: Chuang & Pan, "Rough cut tool path planning for B-spline surfaces using convex hull
// boxes".
std::vector<toolpath::PlannedOperation> plan_hull_rough(const job::Job& job,
                                                        const job::Operation& operation);

}  // namespace cusp::hull_rough
