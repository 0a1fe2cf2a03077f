// Checks of the strategy's input, and its conversion to regions and cells.
#pragma once

#include <string>

#include "host_tools/cam/grid_pocket/cell_grid.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::grid_pocket {

// Throws InputError with the names of the job and the strategy.
[[noreturn]] void refuse_grid_pocket(const job::Job& job, const std::string& what);

// A number for a message, in the job's units.
std::string length_text(const job::Job& job, double mm);

// Errors: InputError for keys that are wrong regardless of geometry.
void check_grid_input(const job::Job& job, const job::Operation& operation);

// The pocket between boundary and islands. Lines are exact; free-form curves are within
// `wall_error` mm.
struct PocketWalls {
    offset::Region2d region;
    double wall_error{};
};
PocketWalls pocket_walls(const job::Job& job, const job::Operation& operation);

// Errors: InputError if part of the pocket has no floor below it, or only trimmed surface.
void check_grid_floor(const job::Job& job,
                      const job::Operation& operation,
                      const offset::Region2d& region);

}  // namespace cusp::grid_pocket
