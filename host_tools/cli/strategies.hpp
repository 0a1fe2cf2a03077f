// The strategies by the names that job files use.
#pragma once

#include <vector>

#include "host_tools/import/job.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::host {

// Plans one operation of the job with the strategy that it names.
// Errors: InputError where the operation can't be planned, or no strategy has that name.
std::vector<PlannedOperation> plan_operation(const Job& job, const Operation& operation);

}  // namespace cusp::host
