// At a corner within a tolerance the next stretch may begin while the last still drains.
//
// A stop ends when the path filter is empty. With a tolerance the new stretch may start a few ticks
// earlier: its first set points are added to the last of the old, which cuts the corner by little
// and saves that time at every corner.
#pragma once

#include "firmware/planner/block.hpp"

namespace cusp::planner {

struct CornerOverlap {
    std::uint8_t ticks{0};  // that the next stretch starts early; 0: not at all
    // Last braking and first acceleration along the path, mm/s^2, and the travel over which they
    // hold, mm.
    float braking{0};
    float speeding{0};
    float before{0};
    float after{0};
};

// One side of a corner.
struct CornerSide {
    EndGeometry end;  // at the corner
    float length;     // mm, of the path without a junction
    float bend{0};    // largest |d2P/ds2| over it, 1/mm
    float change{0};  // and |d3P/ds3|, 1/mm^2
};

// Mean of (h + t)^3/6 under the axis filters, 0 where h + t < 0: h^3/6 + h (a^2 + b^2)/24, and what
// the cut-off adds where they reach farther than h. h in s.
float mean_cube(float h, AxisFilter filter) noexcept;

// The side of which `block` is next to the corner.
CornerSide corner_side(const Block& block, const EndGeometry& end, float length) noexcept;

// The last ticks before a stop only brake and the first after it only speed up (PathServo). While
// both move, an axis has the jerk of both, (t0 u0 + t1 u1)/filter with u0 the braking before
// and u1 the acceleration after, and the tool is |t1 u1 - t0 u0|/filter (h^3/6 + h (a^2 + b^2)/24)
// from the corner at half the overlap h, with a and b the axis filters.
//
//   path_filter  servo ticks.
//   deviation    mm, > 0: by how much the corner may be cut.
//
// Source: docs/numerics.md, "Corners". Held by tests/unit/planner/corner_overlap_test.cpp.
CornerOverlap corner_overlap(const CornerSide& before,
                             const CornerSide& after,
                             const MachineLimits& limits,
                             std::uint32_t path_filter,
                             AxisFilter filter,
                             float deviation) noexcept;

}  // namespace cusp::planner
