// Whether passes of a ball leave no more than the scallop over a mesh, proved triangle by triangle;
// and the passes that are missing where they do leave more.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "host_tools/surface_passes/place_coverage.hpp"

namespace cusp::host {

// As `Coverage`, for facets: what one straight move removes is convex, so a move that removes all
// three corners of a triangle, raised by the scallop, removes all of the triangle raised. Triangles
// that no one move covers are halved. Facets that stand upright, and what lies under others, are
// not looked at.
class FacetCoverage {
public:
    // certified  passes over a mesh: the one of `triangles`
    // scallop    mm: what may be left
    // path_off   mm: how far the path that is cut may be from the points given to `add`
    FacetCoverage(const std::vector<std::array<Vec3d, 3>>& triangles,
                  const CertifiedPasses& certified,
                  double scallop,
                  double path_off);

    // A pass that will be cut, by its tips.
    void add(const Points& tips) { places_.add(tips); }

    // Whether what stands over a place of the mesh is taken off to a share of the scallop.
    //
    // normal  unit, upward
    bool covered(Vec3d place, Vec3d normal, double share) const
    {
        return places_.covered(place, normal, share);
    }

    // mm: between passes on level ground that leave the scallop
    double step() const { return places_.step(); }

    // Looks over all triangles; what is not covered is kept for `close_gaps`.
    void look_over();

    // Passes for what is not covered, each handed to `cut`, which must `add` what it makes of it.
    void close_gaps(const std::function<void(const Points&)>& cut);

    // mm2 of facets, square to them, that keep more than the scallop because the tool can't touch
    // them: feet of walls, concave edges, valleys narrower than the tool.
    double blocked_area() const { return blocked_area_; }

    // Whether the look ended early because too many cells are bare.
    bool overflowed() const { return overflowed_; }
    // Cells that stay uncovered, after `close_gaps`.
    std::size_t uncovered() const { return gaps_.size(); }
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

    void look_into(const Cell& cell, int depth);
    Verdict judge(const Cell& cell) const;
    bool hidden(Vec3d point) const;
    bool low_enough(const Cell& cell) const;
    bool blocked(Vec3d corner, Vec3d normal) const;
    bool settled(const Cell& cell) const;
    std::optional<Place> bare_place(const Cell& cell) const;
    bool may_be_bare(const Cell& cell) const;
    std::optional<Vec3d> missing_tip(const Place& at, bool where_blocked) const;
    Points trace(const Place& from, Vec3d way) const;

    const std::vector<std::array<Vec3d, 3>>& triangles_;
    const CertifiedPasses& certified_;
    const std::vector<Surface> no_surfaces_;
    double scallop_;
    double path_off_;
    PlaceCoverage places_;
    std::vector<Cell> gaps_;
    double most_left_{};
    double blocked_area_{};
    bool overflowed_{};
    bool looking_over_{};
    mutable std::vector<std::uint32_t> near_;
};

}  // namespace cusp::host
