// Warns where a 2.5-D operation cuts above the stock or far below it, or too deep at once.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/job/job.hpp"

namespace cusp::job {

// A sentence for each operation that ends above the stock's top, begins below its bottom, or goes farther than
// its tool's diameter below that; and for each that cuts slots deeper than its tool's diameter in one level,
// where nothing before it has cut the same drawing.
std::vector<std::string> level_warnings(const Job& job);

}  // namespace cusp::job
