// Pockets with free-form floors over a grid of cells, after Choi, Cho & Kim: one navigation for
// rough layers and the finish, a pass along the wall, and optional zigzags.
//
//     const std::vector<toolpath::PlannedOperation> planned = plan_grid_pocket(job, operation);
//     planned.front().path.moves;            // of the tool's tip
//     planned.front().stats.counts;            // cells, steps back, roughness
//
// Better than the paper: heights are exact drops of the tool instead of the floor's height under
// its axis (which cuts in by R(1 - cos) on every slope), every move is proven clear of the floor,
// dead ends are left straight, and layers visit only cells that the floor has not reached.
#pragma once

#include <vector>

#include "host_tools/job/job.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::grid_pocket {

// Plans the operation in the paper's order: layers 1 to N, P (the navigation from its end to its
// start), W (the wall), N (zigzags along x, then y). Reports cells, backtracks, roughness and
// layers.
//
// Errors: InputError where the grid, the walls, the floor or the roughness can't be used; one for
// the roughness names the grid that would do. Source: Choi, Cho & Kim, "A unified rough and finish
// cut algorithm for NC machining of free form pockets with general polygon".
std::vector<toolpath::PlannedOperation> plan_grid_pocket(const job::Job& job,
                                                         const job::Operation& operation);

}  // namespace cusp::grid_pocket
