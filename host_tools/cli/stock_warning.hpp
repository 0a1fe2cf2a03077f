// Warns where the stock's top is not the part's: how much of the path is in air.
#pragma once

#include <optional>
#include <string>

#include "host_tools/cli/plan_statistics.hpp"
#include "host_tools/job/job.hpp"

namespace cusp::cli {

// A sentence where the stock's top is below the part's, and where it is above the part's and a
// third of the feed moves or more are over the part.
std::optional<std::string> stock_warning(const job::Job& job, const Plan& plan);

}  // namespace cusp::cli
