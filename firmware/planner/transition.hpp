// Transitions: where a line meets an arc, or an arc another, curvature jumps; a quintic piece with
// the direction and curvature of both makes the jump a slope.
#pragma once

#include "firmware/base/machine_limits.hpp"
#include "firmware/path/move.hpp"

namespace cusp::planner {

// No transition takes more of a move, mm.
inline constexpr float kLongestReach = 4.0F;

// Shortens two moves and makes the piece between them, as long as `deviation`, mm, allows.
//
//   jerk_time  s, over which the axis filters spread a jump of acceleration.
//
// Returns false, and changes nothing, where none fits or the joint is passed faster as it is: the
// jump of curvature dK limits the speed to v^2 = jerk_time j/dK; the transition's third derivative
// is 9/8 dK over half its length. Source: docs/numerics.md, "Transitions".
bool make_transition(path::Move& before,
                     path::Move& after,
                     path::Move& piece,
                     const MachineLimits& limits,
                     float jerk_time,
                     double deviation) noexcept;

// Cuts the first `length` mm off a line or an arc and returns them.
path::Move take_front(path::Move& move, double length) noexcept;

}  // namespace cusp::planner
