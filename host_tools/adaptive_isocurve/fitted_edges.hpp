// Contours of many short edges as few lines and arcs.
#pragma once

#include <vector>

#include "host_tools/offset/contour.hpp"

namespace cusp::adaptive_isocurve {

// The edges as few lines and arcs (lines alone where not `arcs`), within the tolerance, mm, on
// either side; their ends stay.
std::vector<offset::Edge> fitted_edges(const std::vector<offset::Edge>& edges,
                                       double tolerance,
                                       bool arcs);

}  // namespace cusp::adaptive_isocurve
