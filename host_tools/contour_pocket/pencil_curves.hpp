// Lines along which the height of the tool's tip jumps or its slope turns up: the feet of cliffs,
// creases that the tool does not fit into; and ways through the bottoms of dimples.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/drop_cutter/drop_cutter.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::contour_pocket {

struct PencilPoint {
    Vec2d at;        // just on the low side: where the tip stands lower, or else climbs less
    Vec2d low_side;  // from the line to the low side, unit vector
    bool jump;       // of the height; else its slope turns
};

struct PencilCurve {
    std::vector<PencilPoint> points;
    bool closed;  // from the last point to the first
};

struct PencilSearch {
    offset::Box2d box;                        // where lines are looked for
    std::function<bool(Vec2d place)> inside;  // whether the tool's axis may stand there
    double jump{};                            // mm: smaller ones are not followed
    double fine{};                            // mm: how far chords of a line may lie from it
};

// Looked for on a grid of an eighth of the tool's radius (coarser where the box is longer than 600
// such cells) and followed from there on; lines that none of the grid's edges crosses are missed.
// Slopes count that turn by 0.15 or more.
std::vector<PencilCurve> pencil_curves(const drop_cutter::DropCutter& floor,
                                       const PencilSearch& search);

}  // namespace cusp::contour_pocket
