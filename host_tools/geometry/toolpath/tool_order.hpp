// Reorders operations to save tool changes.
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::toolpath {

// Indices of the operations in their new order. An operation for the current tool is moved ahead of
// those whose cuts are disjoint from its own in plan, so each still meets the same stock. All others
// keep their order.
//
// clearance_z  mm: moves at this height or above cut nothing
std::vector<std::size_t> tool_order(const std::vector<PlannedOperation>& operations,
                                    double clearance_z);

}  // namespace cusp::toolpath
