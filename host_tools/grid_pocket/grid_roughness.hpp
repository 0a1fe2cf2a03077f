// What stands between the tracks: the paper's surface roughness, computed before anything is cut.
#pragma once

#include <cstdint>
#include <functional>
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
// beside walls as a slope, between the cells' tracks and the wall's own.
//
//   heights       of the tip over each cell of the grid; read where the cell is inside
//   to_wall_pass  mm from a point to the pass along the wall; negative beyond it
double grid_roughness(const CellGrid& grid,
                      const std::vector<double>& heights,
                      const Tracks& tracks,
                      const Tool& tool,
                      const std::function<double(Vec2d)>& to_wall_pass);

}  // namespace cusp::host
