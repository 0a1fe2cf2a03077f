// Proved bounds of a floor's slope and second derivative near a place, from its control points, and
// the stepover of a ball that they prove.
#pragma once

#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/part_model/bend_bounds.hpp"

namespace cusp::contour_pocket {

// Largest plan distance, mm, between places of the ball's axis and the nearest pass for which the
// scallop on the floor is at most `scallop_height`, along the normal; 0 where nothing is proved.
//
// Proof: over a floor with second derivatives up to K < 1/R, those of the tip's height are at most
// K / (1 - K R), and at least those of the floor, since the tip's height is a maximum of shifted
// heights of the floor. Seen from a place with height 0 and gradient g, the pass at distance d has
// the height g d + r, with r between -down d^2 / 2 and up d^2 / 2. With q = R - scallop_height, its
// ball reaches the point `scallop_height` above the floor where
//   q^2 + 2 q r cos(slope) + d^2 + (g d + r)^2 <= R^2.
double proven_reach(double radius, double scallop_height, const part_model::BendBounds& bounds);

class HeightBounds {
public:
    // reach  mm: queries include everything within this distance of their box
    HeightBounds(const std::vector<nurbs::Surface>& floor, double reach);

    // Bounds within reach of the box. Finite only for a single surface without trims or inner
    // creases, away from its ends.
    part_model::BendBounds near(const offset::Box2d& box) const;

private:
    struct Cell {
        offset::Box2d box;
        part_model::BendBounds bounds;
    };
    void subdivide(const part_model::BezierCell& cell,
                   int halvings,
                   std::vector<Cell>& found) const;
    void fill_bins(const std::vector<Cell>& found);
    template <class Visit>
    void visit(const offset::Box2d& box, Visit visit) const;

    double reach_;
    double bin_;
    offset::Box2d field_;
    int columns_{};
    int rows_{};
    std::vector<part_model::BendBounds> bins_;
};

}  // namespace cusp::contour_pocket
