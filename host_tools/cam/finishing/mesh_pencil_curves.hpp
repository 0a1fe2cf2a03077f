// Pencil curves of a mesh, along which a ball touches two points at once: feet of walls and sharp
// concave edges. Passes across them leave stock that only a pass along them removes.
#pragma once

#include <vector>

#include "host_tools/cam/finishing/gouge_free_path.hpp"

namespace cusp::finishing {

// Tips along the curves at which the contact of a dropped ball jumps and its normal turns by more
// than 20 degrees. If the height jumps as well, the tips are on the lower side.
//
// pitch  mm, of the grid of the search; shorter curves may be missed
std::vector<Points> mesh_pencil_curves(const GougeFreePathFitter& path_fitter, double pitch);

}  // namespace cusp::finishing
