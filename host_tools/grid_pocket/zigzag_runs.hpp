// The steps between neighbouring cells that the main path did not take, as runs along rows or
// columns: the optional zigzags of Choi, Cho & Kim, figure 3.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/grid_pocket/grid_roughness.hpp"

namespace cusp::grid_pocket {

struct GridRun {
    Cell first;
    Cell last;
};

// Runs along `axis` ('x' or 'y') over every clear step that is no track yet; adds them to the
// tracks. Each run is followed by a near one in the next line, so that the runs beside a diagonal
// of the main path make one way back and forth. O(n log n).
std::vector<GridRun> zigzag_runs(const CellGrid& grid,
                                 char axis,
                                 Tracks& tracks,
                                 const std::function<bool(Cell, Cell)>& clear);

}  // namespace cusp::grid_pocket
