// Links as equal pieces, so that no corner lies beside the pass that a link is tangent to.
#pragma once

#include "host_tools/cam/cl_path/tolerance_chain.hpp"

namespace cusp::cl_path {

// Each edge as equal lines (arcs if `arcs`), as few as stay within the band above the floor's
// height + `allowance` at every `spacing` (mm). Places below `min_z` count as being at `min_z`.
//
// The longest moves, as chain_through() takes them, may end in a short one a few micrometres off
// the loop that the link joins. A machine that stops there (G61) has more set points beside the
// loop than the loop has, and a search for a path's nearest set points finds the wrong ones.
struct EqualPieces {
    StationBand band;
    double allowance;
    double min_z;
    double spacing;
    bool arcs;
};
Chain equal_pieces_chain(const std::vector<offset::Edge>& plan,
                         const PathFloor& floor,
                         const EqualPieces& settings);

}  // namespace cusp::cl_path
