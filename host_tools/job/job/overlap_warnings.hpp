// Warns where operations of a drawing cut into each other's walls.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/job/job.hpp"

namespace cusp::job {

// A sentence for each pair of operations among pocket, profile, v_carve and drill whose outlines cross, with
// the first place. Outlines within each other are as they should be: a hole in a pocket's floor.
std::vector<std::string> overlap_warnings(const Job& job);

}  // namespace cusp::job
