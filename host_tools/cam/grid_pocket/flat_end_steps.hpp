// Steps that a flat end leaves between tracks, from positions of its tip.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "host_tools/cam/grid_pocket/grid_roughness.hpp"

namespace cusp::grid_pocket {

// A place q of the floor could be cut down to the lowest tip of all positions whose disc holds q; it
// is cut down to the lowest of those on tracks. The difference jumps where a track comes out of reach,
// so that its top is often the corner of a sliver that no raster of places meets. Therefore reach is
// counted short: a track counts where its disc holds all places around q up to the next ones looked
// at. Then the result is too high by at most the slope times some tenth of the radius.
//
// Looked at: discs about places a twentieth of the radius apart, on three rings in 128 directions.
// Heights are exact on a lattice of up to 14 places a side of a square between cells, and linear
// between.
class FlatEndSteps {
public:
    FlatEndSteps(const CellGrid& grid,
                 const TipSurface& surface,
                 const Tracks& tracks,
                 double radius);

    // mm: the highest step left by discs about places of the square whose lower left cell is `c`.
    // `evaluations` grows by the number of exact heights.
    double left_in(Cell c, int& evaluations);

private:
    // Heights of one square between cells.
    struct Square {
        std::vector<Vec3d> tips;    // on its tracks to the east and north of its cell, and on walls
        std::vector<Vec3d> places;  // where the axis may be
    };
    // Heights of one square's lattice; NaN where the axis may not be.
    struct Lattice {
        std::size_t columns;
        std::vector<double> z;

        double& at(int i, int j)
        {
            return z[static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(i)];
        }
    };
    const Square& square(Cell c, int& evaluations);
    Square made(Cell c, int& evaluations) const;
    Lattice read(Cell c, Square& out, int& evaluations) const;
    void add_tracks(Cell c, Lattice& lattice, Square& out) const;
    void add_places(Cell c, Lattice& lattice, Square& out) const;
    void collect_tips(Cell c, int& evaluations);
    double left_about(Vec3d place) const;
    std::optional<double> cut_down_to(Vec2d q, const std::vector<Vec3d>& near) const;

    const CellGrid& grid_;
    const TipSurface& surface_;
    const Tracks& tracks_;
    double radius_;
    int nx_;  // of the lattice of a square
    int ny_;
    double step_x_;  // mm, of the lattice
    double step_y_;
    int sub_x_;  // places a step of it
    int sub_y_;
    double short_by_;  // mm: reach
    std::map<std::pair<int, int>, Square> squares_;
    std::vector<Vec3d> tips_;  // around the square, the lowest first
};

}  // namespace cusp::grid_pocket
