// Reachable height of a tool: the closing of the part's heights by the tool.
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/judge/verify/height_grid.hpp"

namespace cusp::verify {

// heights    of the part on the grid; -infinity where there is none
// forbidden  nonzero where the tool's axis may not be
//
// Returns, per grid point, the lowest cut of a tool whose tip goes to all allowed places without
// gouging the part; +infinity where it cannot come.
std::vector<float> lowest_reachable(const std::vector<float>& heights,
                                    const std::vector<char>& forbidden,
                                    const HeightGrid& grid,
                                    const toolpath::Tool& tool);

}  // namespace cusp::verify
