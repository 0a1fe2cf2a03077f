// Adaptive isocurves of a mesh: of the height field that the tip of a ball makes over it.
#pragma once

#include <vector>

#include "host_tools/import/job.hpp"

namespace cusp::host {

// Algorithm 1 of Elber and Cohen on the offset of the mesh, which is exact: a ball let down on the
// triangles. Isocurves run along x (`direction` "v": along y); where two neighbours leave more than
// the scallop under the way in the middle, that part of it is added, and so on. Passes along
// `mesh_creases()` follow, and what `FacetCoverage` finds bare. `operation.mesh` holds the
// triangles.
PlannedOperation plan_mesh_isocurves(const Job& job, const Operation& operation);

}  // namespace cusp::host
