// Pencil curves: lines along which the CL height jumps or its slope turns up. They follow the feet
// of cliffs and creases that the tool does not fit into, and cross the bottoms of dimples.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::contour_pocket {

struct PencilPoint {
    Vec2d at;        // just on the low side: the CL point is lower there, or climbs less
    Vec2d low_side;  // from the line to the low side, unit vector
    bool jump;       // of the height; else the slope turns
};

struct PencilCurve {
    std::vector<PencilPoint> points;
    bool closed;  // from the last point to the first
};

struct PencilSearch {
    offset::Box2d box;                        // searched
    std::function<bool(Vec2d place)> inside;  // whether the tool's axis may be there
    double jump{};                            // mm: smaller jumps are ignored
    double fine{};                            // mm: tolerance of the chords of a line
};

// Searches a grid of an eighth of the tool's radius (coarser where the box is longer than 600 such
// cells) and traces the curves from there. Curves that cross no edge of the grid are missed. A turn
// of the slope counts from 0.15.
std::vector<PencilCurve> pencil_curves(const drop_cutter::DropCutter& floor,
                                       const PencilSearch& search);

}  // namespace cusp::contour_pocket
