// Engraving on surfaces.
#pragma once

#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::prismatic {

// Follows each chain of edges, in order, below the operation's floor: plan_engrave() says how deep.
//
// Errors: InputError where there is no floor under a chain, with the place.
std::vector<toolpath::PlannedOperation> engraved_on_floor(
    const job::Job& job,
    const job::Operation& operation,
    const std::vector<std::vector<offset::Edge>>& chains);

}  // namespace cusp::prismatic
