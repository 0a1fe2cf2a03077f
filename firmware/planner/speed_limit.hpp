// Limits set by the geometry of a stretch of path: its speed, and the acceleration along it.
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
Vec3f larger(Vec3f a, Vec3f b) noexcept;
PathDerivatives larger(const PathDerivatives& a, const PathDerivatives& b) noexcept;

// Speed and acceleration along the path that keep every axis inside its limits. Speeds are squared,
// in (mm/s)^2. The acceleration may be u0 at rest and u1 at the cap, and linear in the squared
// speed in between.
struct SpeedLimit {
    float cap;   // of the squared speed
    float u0;    // mm/s^2
    float u1;    // mm/s^2
    float feed;  // squared programmed feed

    float acceleration_at(float squared_speed) const noexcept
    {
        return squared_speed >= cap ? u1 : u0 - (u0 - u1) * (squared_speed / cap);
    }

    // The acceleration allowed at a speed, mm/s, though the tool, behind half a path filter (s), is
    // faster by what that gains or loses.
    float acceleration_behind(float speed, float half_filter) const noexcept
    {
        if (u0 == u1) {
            return u0;
        }
        const float faster = speed + half_filter * acceleration_at(speed * speed);
        return acceleration_at(faster * faster);
    }
};

// A bound that falls linearly with the squared speed.
struct Line {
    float at_rest;
    float at_cap;
};

// The parts of a speed limit, kept apart until everything that reaches a place is known: the least
// of each part over the places, but not their products, are bounds.
struct Allowance {
    float cap;                // of the squared speed
    float feed;               // squared programmed feed
    Line by_acceleration;     // mm/s^2 along the path, by the axes' acceleration
    Line by_jerk;             // mm/s^2 along the path, by the axes' jerk
    Line jerk_left;           // share of the jerk that junctions leave
    float acceleration_left;  // share of the acceleration that junctions leave
};

inline constexpr float kUnlimited = 1e30F;
inline constexpr Line kNoLine{kUnlimited, kUnlimited};
inline constexpr Allowance kAllowsAll{kUnlimited, kUnlimited, kNoLine, kNoLine, {1, 1}, 1};

// Holds wherever both a and b hold.
Allowance stricter(const Allowance& a, const Allowance& b) noexcept;

// Whether b allows something that a does not.
bool binds(const Allowance& a, const Allowance& b) noexcept;

// Whether one interval may stand for both: they differ by at most 3 %.
bool are_alike(const Allowance& a, const Allowance& b) noexcept;

// All parts together.
SpeedLimit speed_limit(const Allowance& allowance) noexcept;

// The feed override goes up to 200 %: squared, four times.
inline constexpr float kGreatestFeedFactor = 4.0F;

// The fastest that caps and feed allow at any override, mm/s.
float greatest_speed(const Allowance& allowance, bool rapid) noexcept;

// Squared speed is capped where the centripetal acceleration takes this part of an axis' limit, so
// that some is left to change the speed.
inline constexpr float kCentripetalShare = 0.92F;
// And where v^3 |d3P/ds3| takes this part of its jerk.
inline constexpr float kCurvatureJerkShare = 0.5F;
// Of a transition, towards which nothing brakes.
inline constexpr float kTransitionJerkShare = 0.9F;

// The limits of a stretch with such derivatives.
//
//   limits           of the axes.
//   filter_s         length of the path filter, s, > 0: jerk along the path is at most
//                    acceleration/filter_s.
//   max_centripetal  largest |d2P/ds2| v^2, mm/s^2: bounds the deviation by the axis filters.
//   max_speed        mm/s; another bound of the speed.
//
// Each axis keeps  |P'| u + |P''| v^2 <= a  and  |P'| u/filter_s + 3 |P''| v u + |P'''| v^3 <= j.
// Source: docs/numerics.md, "Limits along the path".
Allowance allowance(const PathDerivatives& derivatives,
                    const MachineLimits& limits,
                    float filter_s,
                    float max_centripetal,
                    float max_speed,
                    float jerk_share = kCurvatureJerkShare) noexcept;

}  // namespace cusp::planner
