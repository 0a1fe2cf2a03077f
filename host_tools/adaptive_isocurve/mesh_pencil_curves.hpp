// Where a ball dropped on a mesh touches two places at once: along the feet of walls and in
// sharp concave edges passes across leave metal that only a pass along can take.
#pragma once

#include <vector>

#include "host_tools/finishing/gouge_free_path.hpp"

namespace cusp::adaptive_isocurve {

// Tips along creases of the ball's way over the mesh: on one side it rests on another place than on
// the other, and the normals there differ by more than 20 degrees. Where its height jumps, they
// stand on the lower side.
//
// pitch  mm: of the grid on which they are looked for; shorter ones may be missed
std::vector<finishing::Points> mesh_pencil_curves(const finishing::GougeFreePathFitter& path_fitter,
                                                  double pitch);

}  // namespace cusp::adaptive_isocurve
