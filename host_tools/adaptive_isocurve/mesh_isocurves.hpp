// Adaptive isocurves of a mesh: of the height field that the tip of a ball makes over it.
#pragma once

#include <vector>

#include "host_tools/job/job.hpp"

namespace cusp::adaptive_isocurve {

// Algorithm 1 of Elber and Cohen on the offset of the mesh, which is exact: a ball dropped on the
// triangles. Isocurves run along x (`direction` "v": along y); where two neighbours leave more than
// the scallop under the way in the middle, that part of it is added, and so on. Passes along
// `mesh_pencil_curves()` follow, and what `MeshScallopCheck` finds bare. `operation.mesh` holds the
// triangles.
toolpath::PlannedOperation plan_mesh_isocurves(const job::Job& job,
                                               const job::Operation& operation);

}  // namespace cusp::adaptive_isocurve
