// Rows of the time law: an axis' limits at a place of the path.
//
// With x = v^2 each axis keeps
//
//   acceleration   |q'' x + q' x'/2| <= a (1 - kept)
//   jerk           |q''' x + 3/2 q'' x' + q' x''/2| <= j (1 - kept) x^-1/2
//
// The left sides are linear in the coefficients of x. The right side of the second is convex in x,
// so it lies above its tangent: a step that keeps the tangent keeps the limit.
// Source: docs/numerics.md, "The time law".
#pragma once

#include "firmware/planner/station.hpp"

namespace cusp::planner {

// A row at a state of the law, over its right side: it holds while |value| < left. Each axis has
// a lane.
struct LawRow {
    LaneVec by_value;  // derivatives of the left side by x, x' and x''
    LaneVec by_slope;
    LaneVec by_bend;
    LaneVec value;
    LaneVec left;  // 1 less the kept share
    LaneVec fall;  // of the right side's tangent by x
};

// The row of jerk. `root` is the square root of x.value, > 0.
inline LawRow jerk_row(const LaneDerivatives& q,
                       const KeptShares& kept,
                       const SquaredSpeed& x,
                       float root) noexcept
{
    LawRow row;
    row.by_value = q.third * root;
    row.by_slope = q.second * (1.5F * root);
    row.by_bend = q.first * (0.5F * root);
    row.value = row.by_value * x.value + row.by_slope * x.slope + row.by_bend * x.bend;
    const LaneVec jump = kept.jump * x.value;
    const LaneVec bend = kept.bend * (x.value * root);
    const LaneVec one = all_lanes(1.0F) - kept.always;
    row.left = one - jump - kept.turn * root - bend;
    row.fall = (one + jump + bend * 2.0F) * (0.5F / x.value);
    return row;
}

// The row of acceleration.
//
//   ratio  jerk over acceleration of each axis, 1/s.
inline LawRow acceleration_row(const LaneDerivatives& q,
                               const KeptShares& kept,
                               const LaneVec& ratio,
                               const SquaredSpeed& x,
                               float root) noexcept
{
    LawRow row;
    row.by_value = product(q.second, ratio);
    row.by_slope = product(q.first, ratio) * 0.5F;
    row.by_bend = all_lanes(0.0F);
    row.value = row.by_value * x.value + row.by_slope * x.slope;
    const LaneVec turn = kept.turn_acceleration * root;
    const LaneVec bend = kept.bend_acceleration * x.value;
    row.left = all_lanes(1.0F) - turn - bend;
    row.fall = (turn + bend * 2.0F) * (0.5F / x.value);
    return row;
}

// Share of its right side that a row uses, kept parts included; below 1 while it holds. The largest
// of the axes.
inline float use(const LawRow& row) noexcept
{
    return greatest(0.0F, magnitude(row.value) + (all_lanes(1.0F) - row.left));
}

}  // namespace cusp::planner
