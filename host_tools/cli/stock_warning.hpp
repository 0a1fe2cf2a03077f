// Warns where the stock's top differs from the part's, with the length of the path in air.
#pragma once

#include <optional>
#include <string>

#include "host_tools/cli/plan_statistics.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::cli {

// The warning, in one sentence. No value where the tops are equal, and where the stock is higher
// but less than a third of the feed moves is above the part.
std::optional<std::string> stock_warning(const job::Job& job, const Plan& plan);

}  // namespace cusp::cli
