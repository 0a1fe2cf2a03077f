// Warns where a 2.5-D operation cuts above the stock or far below it.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/job.hpp"

namespace cusp::job {

// A sentence for each operation that ends above the stock's top, begins below its bottom, or goes farther than
// its tool's diameter below that.
std::vector<std::string> level_warnings(const Job& job);

}  // namespace cusp::job
