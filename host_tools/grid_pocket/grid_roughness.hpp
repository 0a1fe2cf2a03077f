// The paper's surface roughness, the scallop between tracks, computed before anything is cut.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "host_tools/grid_pocket/cell_grid.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::grid_pocket {

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

// What the roughness is computed from besides the tracks.
struct TipSurface {
    const std::vector<double>& heights;  // of the tip over each cell; read where it is inside
    // Exact CL height over any point where the axis may be.
    std::function<std::optional<double>(Vec2d)> height;
    // mm from a point to the pass along the wall; negative beyond it.
    std::function<double(Vec2d)> to_wall_pass;
    // The place of that pass nearest to a point.
    std::function<Vec2d(Vec2d)> on_wall_pass;
};

// The largest scallop, square to the surface, that the tracks and the pass along the wall leave
// over the surface that the tool could cut.
//
// All squares between cells are ranked by the heights over the cells. From the highest down they
// are computed with exact heights on a lattice of up to 14 x 14 places, until no other square can
// be higher. Between the places of the lattice the crest is followed to its top. Where too many
// squares are alike, the rest count with the largest ratio found between exact and ranked value.
//
// For a ball the result is not below what a cut in memory leaves, and mostly less than a tenth
// above it; for a flat end it is coarser (tests/property/grid_pocket).
double grid_roughness(const CellGrid& grid,
                      const TipSurface& surface,
                      const Tracks& tracks,
                      const toolpath::Tool& tool);

}  // namespace cusp::grid_pocket
