// Tools that are too short for their job.
#pragma once

#include <string>
#include <vector>

#include "host_tools/cli/plan_statistics.hpp"
#include "host_tools/job/job.hpp"

namespace cusp::cli {

// A warning for each tool that goes deeper below the stock's top than it, or its flutes, are long.
std::vector<std::string> reach_warnings(const job::Job& job, const Plan& plan);

}  // namespace cusp::cli
