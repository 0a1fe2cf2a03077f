// Rapid moves into stock are no plan.
#pragma once

#include "host_tools/cli/plan_statistics.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::cli {

// Errors: InputError if a rapid move of the plan would cut into stock that earlier operations and programs leave:
// operation, place, depth and limit.
void refuse_rapids(const job::Job& job, const Plan& plan);

}  // namespace cusp::cli
