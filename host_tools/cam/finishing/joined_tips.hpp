// From tips of neighbouring places to passes.
#pragma once

#include <vector>

#include "host_tools/cam/finishing/gouge_free_path.hpp"

namespace cusp::finishing {

// Passes through tips in order. Tips may lie apart (on two sides of a ridge): then the pass follows the
// model between them, or ends.
//
// step  mm: between neighbouring passes
std::vector<Points> joined_tips(const Points& tips,
                                const GougeFreePathFitter& path_fitter,
                                double step);

}  // namespace cusp::finishing
