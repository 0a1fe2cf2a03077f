// Pencil curves of a mesh, along which an end touches two points at once: feet of walls and sharp
// concave edges. Passes across them leave stock that only a pass along them removes.
#pragma once

#include <vector>

#include "host_tools/cam/finishing/gouge_free_path.hpp"

namespace cusp::finishing {

// Tips along the curves at which the contact of a dropped end jumps and its normal turns by more
// than 20 degrees. If the height jumps as well, the tips are on the lower side.
//
// pitch  mm, of the grid of the search; shorter curves may be missed
std::vector<Points> mesh_pencil_curves(const GougeFreePathFitter& path_fitter, double pitch);

// The curves near places, where the end may hang over the border of the mesh; each goes on to the lowest tip
// beside its ends, such as the bottom of a pit where three curves end.
//
// places  in plan; the tool's radius is near
std::vector<Points> mesh_pencil_curves_near(const std::vector<Vec3d>& places,
                                            const GougeFreePathFitter& path_fitter,
                                            double pitch);

}  // namespace cusp::finishing
