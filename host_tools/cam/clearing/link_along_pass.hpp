// A link from one closed pass to the next that follows the first as far as necessary.
#pragma once

#include <vector>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::clearing {

// From the start of `before` along it, in the shorter direction, to where a point of `next` is no
// farther than `farthest` (mm), and straight to that point. Empty if there is none.
std::vector<offset::Edge> link_along_pass(const offset::Contour& before,
                                          const offset::Contour& next,
                                          double farthest);

}  // namespace cusp::clearing
