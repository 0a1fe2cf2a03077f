// Dispatches operations to strategies by name.
//
//     for (const job::Operation& operation : job.operations) {
//         for (const auto& planned : strategies::plan_operation(job, operation)) { ... }
//     }
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::strategies {

// Plans one operation of the job with the strategy that it names.
// Errors: InputError where the operation can't be planned, or no strategy has that name.
std::vector<toolpath::PlannedOperation> plan_operation(const job::Job& job,
                                                       const job::Operation& operation);

}  // namespace cusp::strategies
