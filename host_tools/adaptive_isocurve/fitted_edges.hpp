// Contours of many short edges, fitted by few lines and arcs.
#pragma once

#include <vector>

#include "host_tools/offset/contour.hpp"

namespace cusp::adaptive_isocurve {

// Few lines and arcs (without `arcs` lines only) within the tolerance (mm) of the edges on either
// side, with the same ends.
std::vector<offset::Edge> fitted_edges(const std::vector<offset::Edge>& edges,
                                       double tolerance,
                                       bool arcs);

}  // namespace cusp::adaptive_isocurve
