// Regions laid over each other: what they have in common, and what one leaves of the other.
//
//     const auto stays = without(stock, pocket);    // the walls
//     const auto cut = common(pocket, stock);
//
// No input fails, whatever runs along, touches or crosses what at whatever angle: where edges meet
// is decided in integers. A region's points are here those with a winding number above 0, so its
// contours may overlap and repeat each other. The result's border is nowhere farther than 4e-6 mm
// from where it would be exactly; vertices within 1e-6 mm are one; loops of less area than that
// strip along them are left out. Its loops are closed, touch themselves nowhere and each other in
// vertices at most, but for crossings within these 4e-6 mm of arcs that are nearly tangent.
// (tests/property/offset/overlay_property_test.cpp) O(n log n) for spread edges.
#pragma once

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::offset {

// The points of both regions.
Region2d common(const Region2d& a, const Region2d& b);

// The points of either region.
Region2d united(const Region2d& a, const Region2d& b);

// The points of `a` that are not in `b`.
Region2d without(const Region2d& a, const Region2d& b);

}  // namespace cusp::offset
