// The order of operations that changes tools least often.
#pragma once

#include <vector>

#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::toolpath {

// The places of the operations in their new order. One that needs the tool at hand comes forward
// past those whose cuts lie wholly beside its own, seen from above: what it finds and what they
// find is the same. All others keep their order.
//
// clearance_z  mm: moves at this height or above cut nothing
std::vector<std::size_t> tool_order(const std::vector<PlannedOperation>& operations,
                                    double clearance_z);

}  // namespace cusp::toolpath
