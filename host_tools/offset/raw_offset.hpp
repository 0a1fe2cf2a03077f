// The untrimmed offset of contours: one piece for each edge and each corner that opens a gap.
#pragma once

#include "host_tools/offset/contour.hpp"

namespace cusp::host {

struct RawPiece {
    Edge edge;
    bool joined;  // its end is the start of the next piece
    bool last;    // the next piece of this contour is its first one
};

// Pieces of all contours, contour by contour, `distance` (mm, > 0) to the left of the source. Arcs
// whose radius the offset would turn inside out are left out: each of their points lies nearer to
// the arc than `distance`.
std::vector<RawPiece> raw_offset(const Region2d& source, double distance);

}  // namespace cusp::host
