// Roughs a deep pocket in layers of limited depth, leaving an allowance for the finish.
#pragma once

#include <optional>

#include "host_tools/contour_pocket/pocket_task.hpp"

namespace cusp::host {

struct RoughResult {
    PlannedOperation operation;
    std::vector<double> heights;  // z of the layers, from the top
    double first{};               // mm: least distance of the tool's centre from the walls
    double left{};  // mm over the floor at most, where the floor is level: allowance and cusps
};

// Layers for operation.tools.front(), at the depths operation.layers or no deeper than
// operation.max_depth each; no value where neither is given or the tool fits nowhere.
std::optional<RoughResult> plan_rough_layers(const Job& job,
                                             const Operation& operation,
                                             const Region2d& region,
                                             const Budget& budget);

}  // namespace cusp::host
