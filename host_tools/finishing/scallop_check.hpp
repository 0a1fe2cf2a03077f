// Whether passes of a ball leave no more than the scallop, proved cell by cell of the surfaces; and
// the passes that are missing where they do leave more.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "host_tools/finishing/scallop_at_point.hpp"
#include "host_tools/finishing/visibility_from_above.hpp"

namespace cusp::finishing {

// What is left at a place is measured upright and turned square to the surface (steep walls: along
// the normal), where the tool can touch it. Where it
// can't (valleys, concave edges), by what the best position of the tool would leave.
//
// Proof for a cell of the domain: what one straight move removes is convex. Where it holds all four
// corners raised by the scallop, it holds all of the cell raised, by a ball smaller by how far the
// cell is from flat. Cells that no one move covers are halved. The smallest are covered where each
// corner is, with a share of the scallop kept for the slope between.
//
// How far a cell is from flat is taken from the second derivatives at its corners, doubled. Places
// that the tool can't touch are looked at a quarter of a step apart and not proved between.
class ScallopCheck {
public:
    // scallop   mm: what may be left
    // path_off  mm: how far the path that is cut may be from the points given to `add`
    // most_gaps cells not covered that are kept
    ScallopCheck(const std::vector<nurbs::Surface>& surfaces,
                 const GougeFreePathFitter& path_fitter,
                 double scallop,
                 double path_off,
                 std::size_t most_gaps = 1000000);

    // A pass that will be cut, by its tips.
    void add(const Points& tips);

    // Looks over one surface; what is not covered is kept for `add_missing_passes`.
    void check(int surface);
    // The same of what lies between two corners of the domain.
    void check(int surface, Vec2d low, Vec2d high);

    // Whether a look ended early because more cells are bare than are kept.
    bool overflowed() const { return overflowed_; }

    // Passes for what is not covered, each handed to `cut`, which must `add` what it makes of it.
    // progress  called with the share that is done, about
    void add_missing_passes(const std::function<void(const Points&)>& cut,
                            const std::function<void(double)>& progress);

    // Passes over the borders of one surface where it stands upright and open: what the path keeps
    // off such a wall is a sliver that no pass beside it can take down. Trimmed edges have none.
    void add_rim_passes(int surface, const std::function<void(const Points&)>& cut);

    // A part of a surface's domain.
    struct Part {
        int surface;
        Vec2d low;
        Vec2d high;
    };
    // What is left where no pass may be added, measured at middles and corners of the cells not
    // covered. What lies between can be higher.
    struct Unproved {
        std::vector<Part> parts;  // where the tool can touch
        double left{};            // mm: the most there
        double blocked_left{};    // mm: the most in the other cells, over what the tool can reach
    };
    Unproved unproved();

    // Cells that stay uncovered, after `add_missing_passes`.
    std::size_t uncovered() const { return uncovered_.size(); }

    // The most that was found left there over what the tool can reach, mm.
    double most_left() const { return most_left_; }

    // The most that was found standing beside rims and creases over what the tool could reach, mm,
    // since passes keep off those so as not to cut into them from beside; at most as wide as they
    // keep off. Not part of what is left elsewhere; 0 for a one-sided tolerance.
    double left_beside_edges() const { return left_beside_edges_; }

private:
    struct Place {
        double u;
        double v;
    };
    struct Corner {
        int surface;
        double u;
        double v;
        nurbs::SurfacePoint point;
        Vec3d normal;
    };
    struct Cell {
        int surface;
        double u0, u1, v0, v1;
    };
    enum class Verdict : std::uint8_t { kCovered, kHalveU, kHalveV, kUncovered };

    Corner corner(int surface, double u, double v) const;
    bool inside_trims(int surface, double u, double v) const;
    // at  its corners, as `corners_of` gives them
    void check_cell(const Cell& cell, const std::array<Corner, 4>& at, int depth);
    Verdict judge(const Cell& cell, const std::array<Corner, 4>& at) const;
    bool is_covered(const Corner& at) const
    {
        return places_.is_covered(at.point.point, at.normal);
    }
    Verdict thinned(const Cell& cell,
                    const std::array<Corner, 4>& at,
                    double long_u,
                    double long_v) const;
    bool is_steep(const std::array<Corner, 4>& at) const;
    bool is_clear(const Corner& at) const;
    bool blocked(const Corner& at) const { return !is_covered(at) && !is_clear(at); }
    bool is_uncovered(const std::array<Corner, 4>& at) const;
    bool blocked_somewhere(const std::array<Corner, 4>& at) const;
    bool settled(const Cell& cell, const std::array<Corner, 4>& at, const Corner& middle) const;
    bool is_hidden(const Corner& at) const;
    bool lies_under_others(const Cell& cell, const std::array<Corner, 4>& at) const;
    bool lies_under_itself(const std::array<Corner, 4>& at, const Corner& middle) const;
    bool silhouette_above(const std::array<Corner, 4>& at) const;
    const VisibilityFromAbove& visibility() const;
    bool in_narrow_opening(int surface, const Place& middle, const Place& corner_place) const;
    std::optional<Place> uncovered_point(const Cell& cell) const;
    // The tip that is missing at a place; none where nothing is, or the tool can't touch and
    // `where_blocked` is false.
    std::optional<Vec3d> missing_tip(int surface, double u, double v, bool where_blocked) const;
    std::optional<Vec3d> lower_tip(const Corner& at) const;
    std::array<Place, 5> places_of(const Cell& cell) const;
    double scallop_over_reachable(const Corner& at, double resolution);
    std::array<Corner, 4> corners_of(const Cell& cell) const;
    Corner middle_of(const Cell& cell) const;
    static std::array<Cell, 2> halves_of(const Cell& cell, bool along_u);
    std::array<double, 2> sides_of(const Cell& cell) const;
    double most_left_in(const std::vector<Cell>& cells);
    void measure_beside_edges(const std::vector<Cell>& cells);
    std::optional<Vec3d> tip_over_rim(int surface, Vec2d place) const;
    void go_over_rim(int surface,
                     Vec2d from,
                     Vec2d to,
                     const std::function<void(const Points&)>& cut);
    Points trace(int surface, Place place, bool along_u) const;

    const std::vector<nurbs::Surface>& surfaces_;
    const GougeFreePathFitter& path_fitter_;
    double radius_;
    double scallop_;
    double path_off_;
    std::size_t max_uncovered_;
    ScallopAtPoint places_;
    std::vector<Points> waiting_;  // passes given before the first look
    bool looked_{};
    mutable std::optional<VisibilityFromAbove> visibility_;  // many parts need none
    std::vector<Cell> uncovered_;
    double most_left_{};
    double left_beside_edges_{};
    bool overflowed_{};
    mutable bool nearly_uncovered_{};  // what some better tip would take off is nearly the scallop
    mutable double near_share_{1};     // of the scallop: nearly
    mutable bool moved_clear_{};       // some better tip was none, since passes keep off edges
    mutable std::vector<std::uint32_t> near_;
};

}  // namespace cusp::finishing
