// A way from one closed pass to the next that follows the first as far as it must.
#pragma once

#include <vector>

#include "host_tools/offset/contour.hpp"

namespace cusp::clearing {

// From the start of `before` along it, the shorter way round, to where a place of `next` is no
// farther than `farthest` (mm), and straight over to that place. Empty where there is none.
std::vector<offset::Edge> link_along_pass(const offset::Contour& before,
                                          const offset::Contour& next,
                                          double farthest);

}  // namespace cusp::clearing
