// What the strategy is given, checked and brought to regions and cells.
#pragma once

#include <string>

#include "host_tools/grid_pocket/cell_grid.hpp"
#include "host_tools/job/job.hpp"

namespace cusp::grid_pocket {

// Throws InputError that names the job and the strategy.
[[noreturn]] void refuse_grid_pocket(const job::Job& job, const std::string& what);

// A number for a message, in the job's units.
std::string length_text(const job::Job& job, double mm);

// Refuses what can't be used before any geometry is looked at.
void check_grid_input(const job::Job& job, const job::Operation& operation);

// The pocket between boundary and islands. Lines are exact; free curves lie within `wall_error` mm.
struct PocketWalls {
    offset::Region2d region;
    double wall_error{};
};
PocketWalls pocket_walls(const job::Job& job, const job::Operation& operation);

// Refuses a pocket with a place that no floor lies under, or only one that is trimmed away.
void check_grid_floor(const job::Job& job,
                      const job::Operation& operation,
                      const offset::Region2d& region);

}  // namespace cusp::grid_pocket
