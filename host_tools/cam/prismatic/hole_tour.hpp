// Shared by what is done hole by hole: the order, and the holes that are left out.
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::prismatic {

// The holes' indices in the order of a short tour from the origin.
std::vector<std::size_t> hole_tour(const std::vector<job::Hole>& holes);

// Adds a sentence for each of the first few holes that are narrower than the tool, and the number of the others.
void warn_of_narrower_holes(const job::Operation& operation, toolpath::PlannedOperation& planned);

}  // namespace cusp::prismatic
