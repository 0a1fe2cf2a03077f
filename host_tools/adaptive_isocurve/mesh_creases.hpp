// Where a ball that is let down on a mesh meets two places at once: along the feet of walls and in
// sharp concave edges passes across leave metal that only a pass along can take.
#pragma once

#include <vector>

#include "host_tools/surface_passes/certified_pass.hpp"

namespace cusp::host {

// Tips along creases of the ball's way over the mesh: on one side it rests on another place than on
// the other, and the normals there differ by more than 20 degrees. Where its height jumps, they
// stand on the lower side.
//
// pitch  mm: of the grid on which they are looked for; shorter ones may be missed
std::vector<Points> mesh_creases(const CertifiedPasses& certified, double pitch);

}  // namespace cusp::host
