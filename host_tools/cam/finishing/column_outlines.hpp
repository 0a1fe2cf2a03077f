// A region of a wall, by loops, as pieces whose columns are single intervals.
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::finishing {

// x along the wall and y = z, both mm.
using Outline = std::vector<Vec2d>;

// The outline with fewer corners, none of its corners farther from it than `most_off` (mm).
Outline simplified(const Outline& loop, double most_off);

// The outline's part where dot(corner, inward) is at least that (Sutherland & Hodgman). Sides along the
// border may lie twice, and then count as none.
Outline clipped(const Outline& loop, Vec2d inward, double least);

// The pieces of the region that an odd number of loops surrounds. Each outline is that of a piece
// between a lower and an upper polyline over the same x.
//
// longest       mm: longer pieces are divided at corners or across
// most_corners  about as many has a piece at most
std::vector<Outline> column_outlines(const std::vector<Outline>& loops,
                                     double longest,
                                     std::size_t most_corners);

}  // namespace cusp::finishing
