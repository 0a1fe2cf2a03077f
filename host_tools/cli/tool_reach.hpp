// Tools that are too short for their job.
#pragma once

#include <string>
#include <vector>

#include "host_tools/cli/plan_statistics.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::cli {

// A warning for each tool that goes deeper below the stock's top than it, or its flutes, are long, where
// the job does not give the holder or a shank that is wider than the cutter.
std::vector<std::string> reach_warnings(const job::Job& job, const Plan& plan);

// Cuts the stock with the plan where a tool goes as deep as its flutes or its length.
//
// Errors: InputError where stock is cut beyond the flutes, or shank or holder come nearer to it than
// `holder_clearance`: for each part of a tool the operation and the place of the worst contact, its depth,
// and the flutes or the length that would do.
void refuse_contacts(const job::Job& job, const Plan& plan);

}  // namespace cusp::cli
