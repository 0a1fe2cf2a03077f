// Roughs a deep pocket in layers of limited depth, leaving an allowance for the finish.
#pragma once

#include <optional>

#include "host_tools/clearing/clearing.hpp"
#include "host_tools/contour_pocket/cut_depth.hpp"
#include "host_tools/contour_pocket/pocket_task.hpp"

namespace cusp::host {

struct RoughResult {
    PlannedOperation operation;   // without moves where the tool fits nowhere
    std::vector<double> heights;  // z of the layers, from the top; none where it fits nowhere
    double first{};               // mm: least distance of the tool's centre from the walls
    double left{};  // mm over the floor at most, where the floor is level: allowance and cusps
};

// Depth of cut of a layer, mm: max_depth, or the tallest of operation.layers.
double layer_depth(const Operation& operation);

// z of the tip where the passes go lowest, looked at every tool radius.
double lowest_tip(const ClearedRegion& cleared, const TipFloor& floor);

// Layers for operation.tools.front(), at the depths operation.layers or no deeper than
// operation.max_depth each; no value where neither is given. cut_depth as FloorCutter asks for it.
std::optional<RoughResult> plan_rough_layers(const Job& job,
                                             const Operation& operation,
                                             const Region2d& region,
                                             const Budget& budget,
                                             CutDepth* cut_depth);

}  // namespace cusp::host
