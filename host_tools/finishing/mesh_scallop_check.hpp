// Whether passes of a ball leave no more than the scallop over a mesh, proved triangle by triangle;
// and the passes that are missing where they do leave more.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "host_tools/finishing/scallop_at_point.hpp"

namespace cusp::finishing {

// As `Coverage`, for facets: what one straight move removes is convex, so a move that removes all
// three corners of a triangle, raised by the scallop, removes all of the triangle raised. Triangles
// that no one move covers are halved. Facets that stand upright, and what lies under others, are
// not looked at.
class MeshScallopCheck {
public:
    // path_fitter  passes over a mesh: the one of `triangles`
    // scallop    mm: what may be left
    // path_off   mm: how far the path that is cut may be from the points given to `add`
    MeshScallopCheck(const std::vector<std::array<Vec3d, 3>>& triangles,
                     const GougeFreePathFitter& path_fitter,
                     double scallop,
                     double path_off);

    // A pass that will be cut, by its tips.
    void add(const Points& tips) { places_.add(tips); }

    // Whether what stands over a place of the mesh is taken off to a share of the scallop.
    //
    // normal  unit, upward
    bool is_covered(Vec3d place, Vec3d normal, double share) const
    {
        return places_.is_covered(place, normal, share);
    }

    // mm: between passes on level ground that leave the scallop
    double step() const { return places_.step(); }

    // Looks over all triangles; what is not covered is kept for `add_missing_passes`.
    void check();

    // Passes for what is not covered, each handed to `cut`, which must `add` what it makes of it.
    void add_missing_passes(const std::function<void(const Points&)>& cut);

    // mm2 of facets, square to them, that keep more than the scallop because the tool can't touch
    // them: feet of walls, concave edges, valleys narrower than the tool.
    double blocked_area() const { return blocked_area_; }

    // Whether the look ended early because too many cells are bare.
    bool overflowed() const { return overflowed_; }
    // Cells that stay uncovered, after `add_missing_passes`.
    std::size_t uncovered() const { return uncovered_.size(); }
    // The most that was found left there over what the tool can reach, mm.
    double most_left() const { return most_left_; }

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
    // kSettled: the tool can't touch it, and nothing is to be done.
    enum class Verdict : std::uint8_t { kCovered, kHalve, kBlocked, kSettled, kUncovered };

    void check_cell(const Cell& cell, int depth);
    Verdict judge(const Cell& cell) const;
    bool is_hidden(Vec3d point) const;
    bool low_enough(const Cell& cell) const;
    bool blocked(Vec3d corner, Vec3d normal) const;
    bool settled(const Cell& cell) const;
    std::optional<Place> uncovered_point(const Cell& cell) const;
    bool may_be_uncovered(const Cell& cell) const;
    std::optional<Vec3d> missing_tip(const Place& at, bool where_blocked) const;
    Points trace(const Place& from, Vec3d way) const;

    const std::vector<std::array<Vec3d, 3>>& triangles_;
    const GougeFreePathFitter& path_fitter_;
    const std::vector<nurbs::Surface> no_surfaces_;
    double scallop_;
    double path_off_;
    ScallopAtPoint places_;
    std::vector<Cell> uncovered_;
    double most_left_{};
    double blocked_area_{};
    bool overflowed_{};
    bool checking_{};
    mutable std::vector<std::uint32_t> near_;
};

}  // namespace cusp::finishing
