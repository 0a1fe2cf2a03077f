// Links to a pass from the end of the one before it.
#pragma once

#include "host_tools/cam/clearing/clearing.hpp"
#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::clearing {

struct LinkSpace {
    const offset::RegionOffset& offset;
    double wall_clearance;  // mm: least distance of links from the contours
    double stepover;        // mm: straight links are shorter than five of these
};

// Rotates the path so that it starts in the middle of its longest edge, where an entry has room on
// both sides.
void start_at_longest(offset::Contour& path);

// Sets how the pass starts, its link and the link's end on its path. From the end of `before`:
// tangent to both if clear, else tangent to the pass, else straight to the nearest point, else
// along `before` to where the pass is near.
void link_to(ClearingPass& pass, const offset::Contour& before, const LinkSpace& room);

}  // namespace cusp::clearing
