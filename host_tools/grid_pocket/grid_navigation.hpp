// The order in which cells are visited: right, straight on, left, back. Choi, Cho & Kim,
// section 3.3.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "host_tools/grid_pocket/cell_grid.hpp"

namespace cusp::grid_pocket {

enum class StepKind : std::uint8_t {
    kEnter,      // the cutter is lifted over
    kNeighbour,  // one cell on
    kLink        // from a dead end straight to a free cell, or around corners
};

struct NavigationStep {
    Cell cell;
    StepKind kind{};
    std::vector<Vec2d> bends;  // places on the way to the cell where a link turns
};

struct Navigation {
    std::vector<NavigationStep> steps;
    int dead_ends{};
    int backtracks{};  // bends of links: what dead ends cost in moves
    int lifts{};       // links around corners that were given up for a lift
};

struct NavigationRules {
    // Whether a cell takes part at all.
    std::function<bool(Cell)> free;
    // Whether the cutter may go straight between two neighbours, or between any two places.
    std::function<bool(Cell, Cell)> clear_step;
    std::function<bool(Vec2d, Vec2d)> clear_link;
    // Places beside corners of the walls: where links turn best.
    std::vector<Vec2d> corners;
};

// Visits every free cell once. From the left-most cell of least y, heading along +x, it takes the
// first free neighbour in the order right, straight on, left, back, seen in the direction of
// travel. In a dead end the paper goes back along its path; this goes straight to a free cell
// beside visited ones, or by a link with few bends. Which free cell is taken, the nearest or the
// nearest in sight, is tried for the whole pocket and what bends least is kept. Where bends would
// still be more than a hundredth of the steps, the links that bend most become lifts.
//
// Cost: linear in cells, but for the searches in dead ends, each of which ends near the nearest
// free cell.
Navigation navigate(const CellGrid& grid, const NavigationRules& rules);

// The way the paper machines it: from the last cell to the first.
Navigation reversed(Navigation navigation);

}  // namespace cusp::grid_pocket
