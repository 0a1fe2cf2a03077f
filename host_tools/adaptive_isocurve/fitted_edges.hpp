// Contours of many short edges as few lines and arcs.
#pragma once

#include <vector>

#include "host_tools/offset/contour.hpp"

namespace cusp::host {

// The edges as few lines and arcs (lines alone where not `arcs`), within the tolerance, mm, on
// either side; their ends stay.
std::vector<Edge> fitted_edges(const std::vector<Edge>& edges, double tolerance, bool arcs);

}  // namespace cusp::host
