// Outlines of parts that touch, without the edges that they have in common.
#pragma once

#include <string>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::prismatic {

struct ContourGroup {
    offset::Region2d region;
    std::vector<std::size_t> sources;  // of each contour, one of the contours that it is made of
    double common{};                   // mm: length of the edges that are left out
    Vec2d place;                       // on the longest of them
};

// The same points, but for those on edges that two contours run along in opposite directions: no tool gets
// between them, and offsets need contours that are apart. Edges count as one where they are within 1e-6 mm.
ContourGroup without_common_edges(const offset::Region2d& region);

}  // namespace cusp::prismatic
