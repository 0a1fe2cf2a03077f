// Roughs a deep pocket in layers of limited depth, leaving an allowance for the finish.
#pragma once

#include <optional>

#include "host_tools/cam/clearing/axial_depth_tracker.hpp"
#include "host_tools/cam/clearing/clearing.hpp"
#include "host_tools/cam/contour_pocket/pocket_task.hpp"

namespace cusp::contour_pocket {

struct RoughResult {
    toolpath::PlannedOperation operation;  // without moves where nothing is to be roughed
    std::vector<double> heights;           // z of the layers, descending; none without moves
    double wall_clearance{};               // mm: least distance of the tool's centre from the walls
    double left{};  // mm: largest height above a level floor: allowance and scallops
};

// True if the operation names layers, or a depth of cut for them.
bool is_roughed(const job::Operation& operation);

// Depth of cut of a layer, mm: max_depth, or the tallest of operation.layers.
double layer_depth(const job::Operation& operation);

// True if the finish is the last layer: over a level floor, with the tool of roughing and no allowance,
// both would cut the same. Roughing has one layer less then.
bool finish_is_last_layer(const job::Operation& operation);

// mm: between loops of roughing.
double rough_stepover(const job::Operation& operation);

// z of the tip at the lowest point of the passes, sampled every tool radius.
double lowest_tip(const clearing::ClearedRegion& cleared, const drop_cutter::DropCutter& floor);

// Layers for operation.tools.front(), at the depths of operation.layers or no deeper than
// operation.max_depth each; none if neither is given, or where the finish alone is deep enough.
//
// cut_depth  see PocketPathWriter
std::optional<RoughResult> plan_rough_layers(const Pocket& pocket,
                                             clearing::AxialDepthTracker* cut_depth);

}  // namespace cusp::contour_pocket
