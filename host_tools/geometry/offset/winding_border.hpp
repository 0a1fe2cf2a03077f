// The border of what planar segments enclose.
#pragma once

#include <array>

#include "host_tools/geometry/offset/planar_segments.hpp"

namespace cusp::offset {

// Winding numbers about the two regions of an overlay.
using Windings = std::array<int, 2>;

// A part of the border, with the points that belong on its left.
struct BorderPart {
    Segment segment;
    bool backwards;  // to its source
    bool pinched;    // other border leaves its start too
};

// Simple loops of the border between the points for which is_in(windings) and the others. Loops may
// touch at vertices; each has no vertex twice. They come by the x of their first vertices.
//
// segments    planar, closed chains
// first_of_b  segments from this source on are of the second region
std::vector<std::vector<BorderPart>> winding_border(const std::vector<Segment>& segments,
                                                    const GridPoints& points,
                                                    std::size_t first_of_b,
                                                    bool (*is_in)(Windings));

}  // namespace cusp::offset
