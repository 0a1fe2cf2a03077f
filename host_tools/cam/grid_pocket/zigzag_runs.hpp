// Runs along rows or columns over the steps between neighbouring cells that the main path did not
// take: the optional zigzags of Choi, Cho & Kim, figure 3.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/cam/grid_pocket/grid_roughness.hpp"

namespace cusp::grid_pocket {

struct GridRun {
    Cell first;
    Cell last;
};

// Runs along `axis` ('x' or 'y') over every clear step that is not yet a track; adds them to the
// tracks. After each run follows a near one in the next line, so that runs beside a diagonal of the
// main path form a zigzag. O(n log n).
std::vector<GridRun> zigzag_runs(const CellGrid& grid,
                                 char axis,
                                 Tracks& tracks,
                                 const std::function<bool(Cell, Cell)>& clear);

}  // namespace cusp::grid_pocket
