// What stands between the tracks: the paper's surface roughness, computed before anything is cut.
#pragma once

#include <cstdint>
#include <vector>

#include "host_tools/grid_pocket/cell_grid.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::host {

// Which sides between neighbouring cells the cutter runs along, either way.
class Tracks {
public:
    explicit Tracks(const CellGrid& grid) : grid_{grid}, bits_(grid.size(), 0) {}

    // Precondition: the cells are neighbours.
    void add(Cell a, Cell b);
    bool east(Cell c) const { return (bits_[grid_.index(c)] & 1U) != 0; }
    bool north(Cell c) const { return (bits_[grid_.index(c)] & 2U) != 0; }

private:
    const CellGrid& grid_;
    std::vector<std::uint8_t> bits_;
};

// Largest height, square to the surface, that the tracks leave above what the tool could reach.
// Between four cells the surface of tip heights is taken as a paraboloid through their neighbours;
// beside walls only the cells themselves count, though the wall's own pass takes more.
//
//   heights  of the tip over each cell of the grid; read where the cell is inside
double grid_roughness(const CellGrid& grid,
                      const std::vector<double>& heights,
                      const Tracks& tracks,
                      const Tool& tool);

}  // namespace cusp::host
