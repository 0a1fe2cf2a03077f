// Pockets with free-form floors over a grid of cells, after Choi, Cho & Kim: one navigation for
// roughing layers and the finish, a pass along the wall, and optional zigzags.
//
//     const std::vector<toolpath::PlannedOperation> planned = plan_grid_pocket(job, operation);
//     planned.front().path.moves;    // of the tool's tip
//     planned.front().stats.counts;  // cells, backtracks, roughness
//
// Departures from the paper. Heights are exact drops of the tool instead of the floor's height at
// its axis, which gouges by R(1 - cos) on every slope. Every move is proved clear of the floor.
// Dead ends are left straight. Layers visit only cells that the floor has not reached.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::grid_pocket {

// The record of the strategy.
extern const job::Strategy kGridPocket;

// Keys that it alone takes.
struct GridKeys {
    double grid_x{};  // mm, of a cell
    double grid_y{};
    std::vector<char> zigzag;             // 'x', 'y'
    double arc_tolerance{};               // mm; 0: the floor's
    double max_arc_radius{};              // mm; 0: 1000
    std::optional<double> max_roughness;  // mm; none: any
};

// The operation's own keys.
template <class AnyOperation>
decltype(auto) grid_keys(AnyOperation& operation)
{
    return job::parameters_of<GridKeys>(operation);
}

// Plans the operation in the paper's order: layers 1 to N, P (the navigation from its end to its
// start), W (the wall), N (zigzags along x, then y). Reports cells, backtracks, roughness and
// layers.
//
// Errors: InputError if the grid, the walls, the floor or the roughness cannot be used; for the
// roughness it names a sufficient grid. Source: Choi, Cho & Kim, "A unified rough and finish cut
// algorithm for NC machining of free form pockets with general polygon".
std::vector<toolpath::PlannedOperation> plan_grid_pocket(const job::Job& job,
                                                         const job::Operation& operation);

}  // namespace cusp::grid_pocket
