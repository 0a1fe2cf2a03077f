// At a corner within a tolerance the next stretch begins while the last still brakes: how early, when
// both follow the time law.
#pragma once

#include "firmware/base/machine_limits.hpp"
#include "firmware/path/move.hpp"
#include "firmware/planner/block.hpp"
#include "firmware/planner/station_maker.hpp"

namespace cusp::planner {

struct CornerOverlap {
    float time{0};         // s, that the next stretch begins early
    bool disjoint{false};  // no axis moves on both sides
    StopChoice stop{};     // of the elements on both sides
};

// One side of a corner.
struct CornerSide {
    LaneDerivatives end;  // by arc length at the corner
    float length;         // mm, of the stretch
    float block;          // mm, of the block at the corner
    float departure;      // mm, of the path from the programmed one
    path::PathLean lean;  // at the corner
};

// The element of a stop that nothing overlaps.
StopChoice full_stop(const MachineLimits& limits) noexcept;

// The longest time in both elements, by gain: time less what a lower jerk costs.
//
// With jerk w0 before and w1 after an axis has |t0 w0 + t1 w1| of both while they overlap, and the
// tool leaves the corner by |t1 w1 - t0 w0| (h^3/6 + h (a^2 + b^2)/24), h half the overlap, a and b
// the axis filters. If an axis would have too much of both, both elements are lowered.
//
//   deviation  mm, by how much the corner may be cut, with the departure of both sides where they
//              overlap; 0 or less: no overlap.
//
// The overlap ends with the shorter of both elements, unless no axis moves on both sides.
// Source: docs/numerics.md, "Corners". Held by tests/property/motion/motion_limits_test.cpp and path_deviation_test.cpp.
CornerOverlap corner_overlap(const CornerSide& before,
                             const CornerSide& after,
                             const MachineLimits& limits,
                             AxisFilter filter,
                             float deviation) noexcept;

}  // namespace cusp::planner
