// The order of the cells: right, straight on, left, back. Choi, Cho & Kim, section 3.3.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "host_tools/cam/grid_pocket/cell_grid.hpp"

namespace cusp::grid_pocket {

enum class StepKind : std::uint8_t {
    kEnter,      // by a lift
    kNeighbour,  // one cell on
    kLink        // from a dead end to a free cell, straight or around corners
};

struct NavigationStep {
    Cell cell;
    StepKind kind{};
    std::vector<Vec2d> bends;  // bends of a link to the cell, in order
};

struct Navigation {
    std::vector<NavigationStep> steps;
    int dead_ends{};
    int backtracks{};  // bends of links: the extra moves of dead ends
    int lifts{};       // links around corners that were replaced by a lift
};

struct NavigationRules {
    // True if a cell is to be visited.
    std::function<bool(Cell)> free;
    // True if the cutter can move straight between two neighbours, or between any two places.
    std::function<bool(Cell, Cell)> clear_step;
    std::function<bool(Vec2d, Vec2d)> clear_link;
    // Places beside corners of the walls: good bends of links.
    std::vector<Vec2d> corners;
};

// Visits every free cell once. It starts at the left-most cell of least y, heading along +x, and
// takes the first free neighbour in the order right, straight on, left, back, relative to the
// direction of travel. In a dead end the paper goes back along its path. This implementation goes
// straight to a free cell beside visited ones, or by a link with few bends. Both choices of that
// cell, the nearest and the nearest with a straight link, are tried for the whole pocket, and the
// one with fewer bends is kept. If bends would still exceed a hundredth of the steps, the links
// with the most bends become lifts.
//
// Cost: linear in the cells, except for the searches in dead ends, which end near the nearest free
// cell.
// free cell.
Navigation navigate(const CellGrid& grid, const NavigationRules& rules);

// The order in which the paper machines the cells: from the last to the first.
Navigation reversed(Navigation navigation);

}  // namespace cusp::grid_pocket
