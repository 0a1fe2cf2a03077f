// Derivatives of the path, and the speed that the axes allow where it bends.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "firmware/base/lane_vec.hpp"
#include "firmware/base/machine_limits.hpp"
#include "firmware/base/vec.hpp"

namespace cusp::planner {

// Bounds of |dP/ds|, |d2P/ds2| and |d3P/ds3| of each axis over a stretch (1, 1/mm, 1/mm^2).
struct PathDerivatives {
    AxisVecf first;
    AxisVecf second;
    AxisVecf third;
};

// The same, as they are reckoned.
struct LaneDerivatives {
    LaneVec first;
    LaneVec second;
    LaneVec third;
};

inline LaneDerivatives to_lanes(const PathDerivatives& a) noexcept
{
    return {cusp::to_lanes(a.first), cusp::to_lanes(a.second), cusp::to_lanes(a.third)};
}
inline PathDerivatives to_vec(const LaneDerivatives& a) noexcept
{
    return {cusp::to_vec(a.first), cusp::to_vec(a.second), cusp::to_vec(a.third)};
}

// The larger of both, axis by axis.
PathDerivatives larger(const PathDerivatives& a, const PathDerivatives& b) noexcept;
inline LaneDerivatives larger(const LaneDerivatives& a, const LaneDerivatives& b) noexcept
{
    return {larger(a.first, b.first), larger(a.second, b.second), larger(a.third, b.third)};
}

inline constexpr float kUnlimited = 1e30F;

// Share of the jerk that a transition may take, towards which nothing brakes.
inline constexpr float kTransitionJerkShare = 0.9F;

// Greatest squared speed, (mm/s)^2, with such derivatives: each axis keeps its velocity, 0.92 of its
// acceleration by the second and half of its jerk by the third, so that some is left to change the speed.
//
//   max_centripetal  largest |d2P/ds2| v^2, mm/s^2: bounds the deviation by the axis filters.
//   max_speed        mm/s, < 1e12; another bound of the speed.
float squared_cap(const LaneDerivatives& derivatives,
                  const MachineLimits& limits,
                  float max_centripetal,
                  float max_speed) noexcept;

}  // namespace cusp::planner
