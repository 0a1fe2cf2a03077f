// Pencil curves: lines along which the CL height jumps or its slope turns up. They follow the feet
// of cliffs and creases that the tool does not fit into, and cross the bottoms of dimples.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/drop_cutter/drop_cutter.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::contour_pocket {

struct PencilPoint {
    Vec2d at;        // just on the low side: where the CL point is lower, or else climbs less
    Vec2d low_side;  // from the line to the low side, unit vector
    bool jump;       // of the height; else its slope turns
};

struct PencilCurve {
    std::vector<PencilPoint> points;
    bool closed;  // from the last point to the first
};

struct PencilSearch {
    offset::Box2d box;                        // that is searched
    std::function<bool(Vec2d place)> inside;  // whether the tool's axis may be there
    double jump{};                            // mm: smaller ones are not followed
    double fine{};                            // mm: how far chords of a line may lie from it
};

// Searches a grid of an eighth of the tool's radius (coarser where the box is longer than 600 such
// cells) and follows the curves from there. Curves that no edge of the grid crosses are missed.
// Turns of the slope count from 0.15 on.
std::vector<PencilCurve> pencil_curves(const drop_cutter::DropCutter& floor,
                                       const PencilSearch& search);

}  // namespace cusp::contour_pocket
