// The paper's surface roughness: the scallop between tracks, computed before cutting.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "host_tools/cam/grid_pocket/cell_grid.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::grid_pocket {

// The sides between neighbouring cells along which the cutter runs, in either direction.
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

// mm: a contact of a flat end lies on its rim, except for rounding.
inline constexpr double kOnTheRim = 1e-6;

// Input of the roughness besides the tracks.
struct TipSurface {
    const std::vector<double>& heights;  // of the tip at each cell; read for cells inside
    // Exact CL height at any point where the axis may be.
    std::function<std::optional<double>(Vec2d)> height;
    // mm from a point to the wall pass; negative beyond it.
    std::function<double(Vec2d)> to_wall_pass;
    // The point of that pass nearest to a point.
    std::function<Vec2d(Vec2d)> on_wall_pass;
};

// The largest scallop, along the normal, that the tracks and the wall pass leave over the surface
// that the tool can cut.
//
// All squares between cells are ranked by the heights at the cells. From the highest rank down they
// are computed with exact heights on a lattice of up to 14 x 14 places, until no other square can
// be higher. Between lattice places a pattern search finds the top of the ridge. If too many
// squares have similar ranks, the remaining ones count with the largest ratio found between exact
// and ranked value.
//
// For a ball the result is at least the scallop of a cut in memory, and mostly less than a tenth
// above it; for a bull nose it is coarser (tests/property/grid_pocket). For a flat end it is the
// highest step (flat_end_steps.hpp), two or three times what a cut in memory shows.
double grid_roughness(const CellGrid& grid,
                      const TipSurface& surface,
                      const Tracks& tracks,
                      const toolpath::Tool& tool);

}  // namespace cusp::grid_pocket
