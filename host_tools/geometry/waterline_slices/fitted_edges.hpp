// Contours of many short edges, fitted by few lines and arcs.
#pragma once

#include <vector>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::waterline_slices {

// Few lines and arcs (without `arcs` lines only) within the tolerance (mm) of the edges on either
// side, with the same ends.
std::vector<offset::Edge> fitted_edges(const std::vector<offset::Edge>& edges,
                                       double tolerance,
                                       bool arcs);

// The region with its contours fitted by lines and arcs; without those that are no wider than the
// tolerance (mm).
offset::Region2d fitted_region(const offset::Region2d& region, double tolerance);

}  // namespace cusp::waterline_slices
