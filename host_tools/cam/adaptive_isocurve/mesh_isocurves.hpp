// Adaptive isocurves of a mesh: of the height field of a ball's tip over it.
#pragma once

#include <vector>

#include "host_tools/cam/adaptive_isocurve/level_floors.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::adaptive_isocurve {

// Algorithm 1 of Elber & Cohen on the exact offset of the mesh: a tool dropped on the triangles of
// `operation.mesh`. Isocurves run along x (`direction` "v": along y). If two neighbours leave
// more than the scallop half way between them, that part of the middle isocurve is added, and so
// on. Passes along mesh_pencil_curves() follow, then those over uncovered cells of
// `MeshCheck`, then those along vertical walls that it finds with stock left.
//
// Not claimed by the scallop bound: vertical walls beside which the ball has nothing below it.
toolpath::PlannedOperation plan_mesh_isocurves(const job::Job& job,
                                               const job::Operation& operation,
                                               const LevelFloors& floors = {});

}  // namespace cusp::adaptive_isocurve
