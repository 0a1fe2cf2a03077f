// What the strategy is given, checked and brought to regions and cells.
#pragma once

#include <string>

#include "host_tools/grid_pocket/cell_grid.hpp"
#include "host_tools/import/job.hpp"

namespace cusp::host {

// Throws InputError that names the job and the strategy.
[[noreturn]] void refuse_grid_pocket(const Job& job, const std::string& what);

// A number for a message, in the job's units.
std::string length_text(const Job& job, double mm);

// Refuses what can't be used before any geometry is looked at.
void check_grid_input(const Job& job, const Operation& operation);

// The pocket between boundary and islands. Lines are exact; free curves lie within `wall_error` mm.
struct PocketWalls {
    Region2d region;
    double wall_error{};
};
PocketWalls pocket_walls(const Job& job, const Operation& operation);

// Refuses a pocket with a place that no floor lies under, or only one that is trimmed away.
void check_grid_floor(const Job& job, const Operation& operation, const Region2d& region);

}  // namespace cusp::host
