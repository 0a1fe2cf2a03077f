// Curves of links in even pieces: no corner comes to lie beside the pass that they are tangent to.
#pragma once

#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/contour_pocket/tolerance_chain.hpp"

namespace cusp::host {

// Each edge as equal lines (arcs where `arcs`), as few as stay within `aside` in plan and [low,
// high] over the floor's height + `raise` at every `spacing` (mm); places lower than `level` count
// as if they were level.
//
// The longest moves that fit, as chain_through() takes them, may end in a short one a few
// micrometres off the loop that the link joins. A machine that stops there (G61) has more set
// points beside the loop than the loop has itself, and who looks for a path's nearest set points
// finds the wrong ones.
struct EvenPieces {
    double aside;
    double low;
    double high;
    double raise;
    double level;
    double spacing;
    bool arcs;
};
Chain even_chain(const std::vector<Edge>& plan, const TipFloor& floor, const EvenPieces& settings);

}  // namespace cusp::host
