// Dispatches operations to strategies by name.
#pragma once

#include <vector>

#include "host_tools/job/job.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::cli {

// Plans one operation of the job with the strategy that it names.
// Errors: InputError where the operation can't be planned, or no strategy has that name.
std::vector<toolpath::PlannedOperation> plan_operation(const job::Job& job,
                                                       const job::Operation& operation);

}  // namespace cusp::cli
