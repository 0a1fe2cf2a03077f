// What a tool leaves at best: the part's heights closed by the tool.
#pragma once

#include <vector>

#include "host_tools/toolpath/toolpath.hpp"
#include "host_tools/verify/height_grid.hpp"

namespace cusp::verify {

// heights    of the part over the grid; -infinity where there is none
// forbidden  where the tool's axis may not be (not 0)
//
// Returns, per grid point, the lowest that the tool cuts when its tip goes everywhere it may
// without cutting the part; +infinity where it can't come.
std::vector<float> lowest_reachable(const std::vector<float>& heights,
                                    const std::vector<char>& forbidden,
                                    const HeightGrid& grid,
                                    const toolpath::Tool& tool);

}  // namespace cusp::verify
