// The table of strategies.
//
//     const job::Job job = import::read_job("part.toml", strategies::all());
//     for (const job::Operation& operation : job.operations) {
//         for (const auto& planned : strategies::plan_operation(job, operation)) { ... }
//     }
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::strategies {

// Every strategy of this build, in the order in which errors and help name them.
const job::Strategies& all();

// Plans one operation of the job with its strategy.
// Errors: InputError where the operation can't be planned, or has no strategy.
std::vector<toolpath::PlannedOperation> plan_operation(const job::Job& job,
                                                       const job::Operation& operation);

}  // namespace cusp::strategies
