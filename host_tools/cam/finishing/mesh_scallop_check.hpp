// Proof that passes of any end leave no more than the scallop over a mesh, triangle by triangle, and
// the missing passes where they leave more.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "host_tools/cam/finishing/mesh_ground.hpp"

namespace cusp::finishing {

// The counterpart of `ScallopCheck` for facets. The volume that one straight move of a convex end removes
// is convex. Thus a move that removes all three corners of a triangle, raised by the scallop, removes
// the whole raised triangle; others are halved. Walls are triangles as any other, with two sides.
//
// Where the tool can't touch, nothing is claimed: a facet that is too near to the tool at all three
// corners is so between them as well. There passes go along the lowest places that a search finds.
// Facets hidden under others, and vertical ones with nothing of the part beside them, are left out.
//
// The stock counts as thick as it is along the normal; of a ball, over ground that is not steep, as it is
// vertically, multiplied by the cosine of the slope.
class MeshScallopCheck {
public:
    // path_fitter  of passes over the mesh of `triangles`
    // scallop      mm: allowed height of uncut stock
    // path_off     mm: maximum distance between the path that is cut and the points given to add()
    MeshScallopCheck(const std::vector<std::array<Vec3d, 3>>& triangles,
                     const GougeFreePathFitter& path_fitter,
                     double scallop,
                     double path_off);

    // A pass that will be cut, by its tips.
    void add(const Points& tips) { ground_.add(tips); }

    // True if the stock over a point of the mesh is cut down to a share of the scallop.
    //
    // normal  unit vector, upward
    bool is_covered(Vec3d place, Vec3d normal, double share) const
    {
        return ground_.is_covered({place, normal}, share);
    }

    // mm: of passes on level ground
    double step() const { return ground_.step(); }

    // Checks all triangles, on several threads. Uncovered cells are kept for add_missing_passes().
    void check();

    // Adds passes over uncovered cells. Each is given to `cut`, which must add() the path it cuts.
    void add_missing_passes(const std::function<void(const Points&)>& cut);

    // Measures the stock left in the uncovered cells and forgets those where no pass is missing, as
    // the end of add_missing_passes() does.
    void measure_left();

    // mm2 of facets with more than the scallop left because the tool cannot touch them: feet of
    // walls, concave edges, valleys narrower than the tool.
    double blocked_area() const;

    // True if the check ended early because of too many uncovered cells.
    bool overflowed() const { return overflowed_; }
    std::size_t uncovered() const { return open_.size(); }
    // The highest stock measured there, mm.
    double most_left() const { return most_left_; }

    // mm of walls that neither passes nor claims are made for: see walls_over_nothing().
    double over_nothing() const { return over_nothing_; }

private:
    struct Cell {
        std::array<Vec3d, 3> corners;
        Vec3d normal;

        Vec3d middle() const { return (corners[0] + corners[1] + corners[2]) / 3.0; }
        MeshPlace place() const { return {middle(), normal}; }
        double area() const;
    };
    struct Findings {
        std::vector<Cell> open;     // the tool can touch them
        std::vector<Cell> blocked;  // it cannot
        bool overflowed{};
    };
    class CellSearch;

    std::vector<Cell> sides() const;
    Findings look_at(const std::vector<Cell>& cells) const;
    bool cut_missing(const std::function<void(const Points&)>& cut);
    void cut_lowest(const std::function<void(const Points&)>& cut);
    Points trace(const MeshPlace& from, Vec3d way) const;
    Points trace_wall(const MeshPlace& from) const;
    Points longest_trace(const MeshPlace& from) const;
    std::optional<MeshPlace> beside_on_wall(const MeshPlace& at, Vec3d tip) const;

    const std::vector<std::array<Vec3d, 3>>& triangles_;
    MeshGround ground_;
    std::vector<Cell> open_;
    std::vector<Cell> blocked_;
    double most_left_{};
    double over_nothing_{};
    bool overflowed_{};
};

}  // namespace cusp::finishing
