// What the geometry of a stretch of path allows: its speed, and the acceleration along it.
#pragma once

#include "firmware/base/machine_limits.hpp"
#include "firmware/base/vec.hpp"

namespace cusp::planner {

// Bounds of |dP/ds|, |d2P/ds2| and |d3P/ds3| of each axis over a stretch (1, 1/mm, 1/mm^2).
struct PathDerivatives {
    Vec3f first;
    Vec3f second;
    Vec3f third;
};

// The larger of both, axis by axis.
PathDerivatives larger(const PathDerivatives& a, const PathDerivatives& b) noexcept;

// Speed and acceleration along the path that keep every axis inside its limits. Speeds are squared,
// in (mm/s)^2. The acceleration may be u0 at rest and u1 at the cap; in between linear in the
// squared speed, which is below the true bound because that is concave.
struct SpeedLimit {
    float cap;   // of the squared speed
    float u0;    // mm/s^2
    float u1;    // mm/s^2
    float feed;  // squared programmed feed

    float acceleration_at(float squared_speed) const noexcept
    {
        return squared_speed >= cap ? u1 : u0 - (u0 - u1) * (squared_speed / cap);
    }
};

inline constexpr float kUnlimited = 1e30F;
inline constexpr SpeedLimit kNoLimit{kUnlimited, kUnlimited, kUnlimited, kUnlimited};

// Holds wherever both a and b hold.
SpeedLimit stricter(const SpeedLimit& a, const SpeedLimit& b) noexcept;

// Squared speed is capped where the centripetal acceleration takes this part of an axis' limit, so
// that some is left to change the speed.
inline constexpr float kCentripetalShare = 0.92F;
// And where v^3 |d3P/ds3| takes this part of its jerk.
inline constexpr float kCurvatureJerkShare = 0.8F;

// The limit over a stretch with such derivatives.
//
//   limits      of the axes.
//   jerk_share  of the axes' jerk that the stretch may use, in (0, 1].
//   filter_s    length of the path filter, s, > 0: jerk along the path is at most
//   acceleration/filter_s. max_centripetal  largest |d2P/ds2| v^2, mm/s^2: bounds the deviation by
//   the axis filters. max_speed   mm/s; another bound of the speed.
//
// Each axis keeps  |P'| u + |P''| v^2 <= a  and  |P'| u/filter_s + 3 |P''| v u + |P'''| v^3 <= j.
// Source: docs/numerics.md, "Limits along the path".
SpeedLimit speed_limit(const PathDerivatives& derivatives,
                       const MachineLimits& limits,
                       float jerk_share,
                       float filter_s,
                       float max_centripetal,
                       float max_speed) noexcept;

}  // namespace cusp::planner
