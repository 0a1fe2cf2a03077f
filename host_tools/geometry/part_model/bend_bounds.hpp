// Slope and bend of a piece of a surface as a height z(x, y): bounds proved by its control points.
#pragma once

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/part_model/bezier_cell.hpp"

namespace cusp::part_model {

// In any plan direction; infinite where nothing is proved.
struct BendBounds {
    double slope{};
    double up{};    // largest second derivative, 1/mm
    double down{};  // minus the least second derivative, 1/mm
};

inline constexpr BendBounds kNoBendBounds{kInfinite, kInfinite, kInfinite};

// Over a cell. kNoBendBounds where it may be vertical somewhere.
//
// spread  of the cell; none: the values at its middle
BendBounds bend_bounds(const BezierCell& cell, const BezierCell::Spread& spread);

// Makes bounds hold where either does.
void widen(BendBounds& bounds, const BendBounds& by);

}  // namespace cusp::part_model
