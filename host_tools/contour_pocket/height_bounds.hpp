// Bounds of a floor's slope and bend near a place, proven from its control points; and the stepover
// of a ball that such bounds prove.
#pragma once

#include <vector>

#include "host_tools/nurbs/nurbs.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::part_model {
class BezierCell;
}

namespace cusp::contour_pocket {

// Of the floor as a height z(x, y), in any direction of the plan; infinite where nothing is proven.
struct BendBounds {
    double slope{};
    double up{};    // second derivative, 1/mm: at most
    double down{};  // at least -down
};

// Largest distance in plan, mm, between places of the ball's axis and the nearest pass, so that the
// floor that the ball would touch from there is left no higher than `scallop_height`, square to the
// floor; 0 where nothing is proven.
//
// The tip's height over a floor that bends up by at most K < 1/R bends up by at most K / (1 - K R),
// and down by no more than the floor (the height is the highest of the floor's heights moved by the
// tool's shape). From the place of height 0 and gradient g the pass at distance d then lies
// g d + r high, with r between -down d^2 / 2 and up d^2 / 2; its ball reaches the place
// `scallop_height` over the floor where, with q = R - scallop_height,
// q^2 + 2 q r cos(slope) + d^2 + (g d + r)^2 <= R^2.
double proven_reach(double radius, double scallop_height, const BendBounds& bounds);

class HeightBounds {
public:
    // reach  mm: what lies within it of a box counts for the box
    HeightBounds(const std::vector<nurbs::Surface>& floor, double reach);

    // Within reach of the box. Known for a single surface without trims and without edges inside,
    // away from its ends.
    BendBounds near(const offset::Box2d& box) const;

private:
    struct Cell {
        offset::Box2d box;
        BendBounds bounds;
    };
    void look(const part_model::BezierCell& cell, int halvings, std::vector<Cell>& found) const;
    void sort(const std::vector<Cell>& found);
    template <class Visit>
    void visit(const offset::Box2d& box, Visit visit) const;

    double reach_;
    double bin_;
    offset::Box2d field_;
    int columns_{};
    int rows_{};
    std::vector<BendBounds> bins_;
};

}  // namespace cusp::contour_pocket
