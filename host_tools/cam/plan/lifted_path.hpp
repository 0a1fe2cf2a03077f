// A path whose rapid moves stay out of the stock that they would meet.
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/judge/verify/path_rapids.hpp"

namespace cusp::plan {

// A rapid move straight down ends toolpath::kRapidClearance above the stock that its end is in, then the tool goes on
// at the plunge feed; any other one goes up to the clearance height first, across and down. A drilling cycle keeps its
// pecks in that stock, and clears its chips above it.
//
// rapids       of this path, in order
// clearance_z  mm: over all stock
toolpath::Toolpath lifted(const toolpath::Toolpath& path,
                          const std::vector<verify::RapidInStock>& rapids,
                          double clearance_z);

}  // namespace cusp::plan
