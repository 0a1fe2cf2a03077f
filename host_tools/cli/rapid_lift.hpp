// Rapid moves that would end in stock end above it: the rest of the way down is feed.
#pragma once

#include "host_tools/cli/plan_statistics.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::cli {

// Where an operation begins below stock that stands by then, its rapid moves down end kRapidClearance above that stock
// and the tool goes on at the plunge feed, a pecking drill in pecks; rapid moves across it run at the clearance height.
// A warning of each operation says how many and how deep. Measures are those of before.
//
// Errors: InputError if a move in the place of another would touch a fixture.
void lift_rapids(const job::Job& job, Plan& plan);

// Errors: InputError if a rapid move of the plan would cut into stock that earlier operations and programs leave:
// operation, place, depth and limit.
void refuse_rapids(const job::Job& job, const Plan& plan);

}  // namespace cusp::cli
