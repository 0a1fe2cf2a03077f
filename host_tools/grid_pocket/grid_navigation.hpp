// The order in which cells are visited: right, straight on, left, back. Choi, Cho & Kim,
// section 3.3.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "host_tools/grid_pocket/cell_grid.hpp"

namespace cusp::host {

enum class StepKind : std::uint8_t {
    kEnter,      // a part of the pocket that no free cell leads to: the cutter is lifted over
    kNeighbour,  // one cell on
    kLink        // from a dead end straight to a free cell, or through a visited one
};

struct NavigationStep {
    Cell cell;
    StepKind kind{};
};

struct Navigation {
    std::vector<NavigationStep> steps;
    int dead_ends{};
    int backtracks{};  // steps onto cells that were visited before
};

struct NavigationRules {
    // Whether a cell takes part at all.
    std::function<bool(Cell)> free;
    // Whether the cutter may go straight between two neighbours, or between any two cells.
    std::function<bool(Cell, Cell)> clear_step;
    std::function<bool(Cell, Cell)> clear_link;
};

// Visits every free cell once. From the left-most cell of least y, heading along +x, it takes the
// first free neighbour in the order right, straight on, left, back, seen in the direction of
// travel. In a dead end the paper goes back along its path; this goes by the shortest way over
// visited cells to the nearest one with a free neighbour, and straight to that neighbour where the
// way is clear, so that most dead ends cost no step.
//
// Cost: linear in cells, but for the searches in dead ends, each of which ends at the nearest free
// cell.
Navigation navigate(const CellGrid& grid, const NavigationRules& rules);

// The way the paper machines it: from the last cell to the first.
Navigation reversed(Navigation navigation);

}  // namespace cusp::host
