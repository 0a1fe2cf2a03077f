// Proof that passes of a ball leave no more than the scallop over a mesh, triangle by triangle, and
// the missing passes where they leave more.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "host_tools/cam/finishing/scallop_at_point.hpp"
#include "host_tools/cam/finishing/uncut_walls.hpp"
#include "host_tools/cam/finishing/work_in_shares.hpp"

namespace cusp::finishing {

// The counterpart of `ScallopCheck` for facets. The volume that one straight move removes is
// convex. Thus a move that removes all three corners of a triangle, raised by the scallop, removes
// the whole raised triangle. Triangles that no single move covers are halved. Facets hidden under
// others are not checked. Vertical ones, and those that hardly lean, are checked by `WallSide`:
// where the side of a ball reaches them that rests on something.
//
// Over a steep facet the stock may be high and still thin: it counts as thick as it is vertically,
// multiplied by the cosine of the slope, or as it is along the normal, whichever is less.
//
// Not for use by two threads at once. Long searches run on several, each with a copy that shares the
// passes; which copy looks at which cell does not depend on the number of threads.
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
    void add(const Points& tips) { places_.add(tips); }

    // True if the stock over a point of the mesh is cut down to a share of the scallop.
    //
    // normal  unit vector, upward
    bool is_covered(Vec3d place, Vec3d normal, double share) const
    {
        return places_.is_covered(place, normal, share);
    }

    // mm: stepover on level ground that leaves the scallop
    double step() const { return places_.step(); }

    // Checks all triangles. Uncovered cells are kept for add_missing_passes().
    void check();

    // Adds passes over uncovered cells. Each is given to `cut`, which must add() the path it cuts.
    void add_missing_passes(const std::function<void(const Points&)>& cut);

    // Measures the stock left in the uncovered cells and forgets those where no pass is missing, as
    // the end of add_missing_passes() does.
    void measure_left();

    // mm2 of facets with more than the scallop left because the tool cannot touch them: feet of
    // walls, concave edges, valleys narrower than the tool.
    double blocked_area() const { return blocked_area_; }

    // True if the check ended early because of too many uncovered cells.
    bool overflowed() const { return overflowed_; }
    // Cells and vertical facets that measure_left() kept.
    std::size_t uncovered() const { return uncovered_.size() + walls_.size(); }
    // The highest stock measured there above what the tool can reach, mm.
    double most_left() const { return most_left_; }

    // mm of walls that neither passes nor claims are made for: see walls_over_nothing().
    double over_nothing() const { return over_nothing_; }

    MeshScallopCheck(const MeshScallopCheck&) = delete;
    MeshScallopCheck& operator=(const MeshScallopCheck&) = delete;

    // Calls work(copy, k) for each k below count, on several threads, in shares that do not depend on
    // their number. The copies have the passes of this one and no cells.
    void share_out(std::size_t count,
                   const std::function<void(MeshScallopCheck&, std::size_t)>& work);

private:
    struct Place {
        Vec3d point;
        Vec3d normal;
    };
    struct Cell {
        std::array<Vec3d, 3> corners;
        Vec3d normal;

        Vec3d middle() const { return (corners[0] + corners[1] + corners[2]) / 3.0; }
    };
    // kSettled: the tool cannot touch it and has no lower position over it.
    enum class Verdict : std::uint8_t { kCovered, kHalve, kBlocked, kSettled, kUncovered };

    // A copy for another thread: without cells, with the passes of this one.
    struct ForThread {};
    MeshScallopCheck(const MeshScallopCheck& other, ForThread tag);
    ReachableHeight::Drops work_at(
        OpenShare& share, const std::function<void(MeshScallopCheck&, std::size_t)>& work) const;
    // The main work of a copy: drops, and cells looked at.
    std::size_t effort() const { return places_.drops_made() + judged_; }
    // The longest side of a triangle and its number.
    struct LongSide {
        double length;
        std::size_t side;
    };
    static LongSide longest_side(const std::array<Vec3d, 3>& corners);
    static std::array<Cell, 2> halves_of(const Cell& cell, std::size_t side);
    void divide(const Cell& cell, int depth, std::vector<Cell>& out) const;
    double left_over(const Cell& cell) const;
    void check_cell(const Cell& cell, int depth);
    Verdict judge(const Cell& cell) const;
    Verdict judge_steep(const Cell& cell, double longest) const;
    bool is_upright(Vec3d normal) const;
    std::vector<WallFacet> vertical_facets() const;
    Points trace_level(const Place& from) const;
    std::optional<Place> place_on(Vec3d at) const;
    bool is_hidden(Vec3d point) const;
    bool is_hidden(const Place& at) const;
    bool low_enough(const Cell& cell) const;
    bool blocked(Vec3d corner, Vec3d normal) const;
    bool falls_off_beside(Vec3d point) const;
    bool settled(const Cell& cell) const;
    std::optional<Place> uncovered_point(const Cell& cell) const;
    bool may_be_uncovered(const Cell& cell) const;
    std::optional<Vec3d> missing_tip(const Place& at, bool where_blocked) const;
    Points trace(const Place& from, Vec3d way) const;
    struct Neighbours;
    std::vector<Cell> cut_missing(const std::vector<Cell>& open,
                                  const std::function<void(const Points&)>& cut);
    std::vector<Neighbours> missing_by_neighbours(const std::vector<Cell>& open);
    Points longest_trace(const Place& from) const;

    const std::vector<std::array<Vec3d, 3>>& triangles_;
    const GougeFreePathFitter& path_fitter_;
    const std::vector<nurbs::Surface> no_surfaces_;
    double scallop_;
    double path_off_;
    ScallopAtPoint places_;
    std::vector<Cell> uncovered_;
    UncutWalls walls_;
    double most_left_{};
    double over_nothing_{};
    double blocked_area_{};
    bool overflowed_{};
    mutable std::size_t judged_{};  // cells
    bool checking_{};
    mutable std::vector<std::uint32_t> near_;
};

}  // namespace cusp::finishing
