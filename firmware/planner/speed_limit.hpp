// Limits set by the geometry of a stretch of path: its speed, and the acceleration along it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "firmware/base/lane_vec.hpp"
#include "firmware/base/machine_limits.hpp"
#include "firmware/base/vec.hpp"
#include "firmware/path/move.hpp"

namespace cusp::planner {

// Bounds of |dP/ds|, |d2P/ds2| and |d3P/ds3| of each axis over a stretch (1, 1/mm, 1/mm^2).
struct PathDerivatives {
    Vec3f first;
    Vec3f second;
    Vec3f third;
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

// A share of a limit in [0, 1], kept in 16 bits: 1 is exact, others are rounded down.
class Share {
public:
    Share() noexcept = default;
    constexpr Share(float share) noexcept
        : taken_{static_cast<std::uint16_t>(
              share >= 1.0F ? 0.0F : (share > 0 ? (1.0F - share) * kOne + 0.999F : kOne - 1.0F))}
    {
    }
    constexpr bool is_whole() const noexcept { return taken_ == 0; }
    constexpr operator float() const noexcept { return 1.0F - static_cast<float>(taken_) / kOne; }

private:
    static constexpr float kOne = 65536.0F;
    std::uint16_t taken_;
};

// Speed and acceleration along the path that keep every axis inside its limits, though the tool,
// behind half a path filter, may be faster by what that gains or loses. Speeds are squared, in
// (mm/s)^2. The acceleration is `least` from where the tool may be at the cap. Up to there it falls
// along three chords, which end at a half, at three quarters and at all of that speed.
struct SpeedLimit {
    float cap;      // of the squared speed
    float at_rest;  // mm/s^2
    float least;    // mm/s^2
    float feed;     // squared programmed feed
    Share half;     // of at_rest, at a half
    Share most;     // and at three quarters

    // mm/s^2, at a speed, mm/s, with half the length of the path filter, s, that it was made for.
    float acceleration_at(float speed, float half_filter) const noexcept
    {
        return at_rest == least ? least : acceleration_below(speed, least_from(half_filter));
    }

    // mm/s: from there on the acceleration is the least.
    float least_from(float half_filter) const noexcept
    {
        return std::sqrt(cap) - half_filter * least;
    }
    // As acceleration_at(), `from` being least_from(). Precondition: at_rest != least.
    float acceleration_below(float speed, float from) const noexcept
    {
        if (speed >= from) {
            return least;
        }
        const float quarters = 4.0F * speed / from;
        const float at_half = at_rest * half;
        if (quarters < 2.0F) {
            return at_rest - (at_rest - at_half) * (0.5F * quarters);
        }
        const float at_most = at_rest * most;
        return quarters < 3.0F ? at_half - (at_half - at_most) * (quarters - 2.0F)
                               : at_most - (at_most - least) * (quarters - 3.0F);
    }
};

// A bound that falls linearly with the squared speed.
struct Line {
    float at_rest;
    float at_cap;
};

// Shares that fall likewise.
struct ShareLine {
    Share at_rest;
    Share at_cap;
};

// A bound of two lines over the squared speed, the second of which falls no less steeply.
struct BentLine {
    float at_rest;
    float at_half;  // of the cap
    float at_cap;
};

// The parts of a speed limit, kept apart until everything that reaches a place is known: the least
// of each part over the places, but not their products, are bounds.
struct Allowance {
    float cap;                // of the squared speed
    float feed;               // squared programmed feed
    Line by_acceleration;     // mm/s^2 along the path, by the axes' acceleration
    BentLine by_jerk;         // mm/s^2 along the path, by the axes' jerk
    ShareLine jerk_left;      // share of the jerk that junctions leave
    float acceleration_left;  // share of the acceleration that junctions leave
};

inline constexpr float kUnlimited = 1e30F;
inline constexpr Line kNoLine{kUnlimited, kUnlimited};
inline constexpr BentLine kNoBentLine{kUnlimited, kUnlimited, kUnlimited};
inline constexpr Allowance kAllowsAll{kUnlimited, kUnlimited, kNoLine, kNoBentLine, {1, 1}, 1};

// Leaves of `a` what holds wherever both a and b hold. Precondition: caps are above 0.
void restrict_to(Allowance& a, const Allowance& b) noexcept;

// As restrict_to() with an allowance of all but a faster feed, the same bits.
void restrict_to_feed(Allowance& a, float squared_feed) noexcept;

// True if b allows something that a does not.
bool binds(const Allowance& a, const Allowance& b) noexcept;

// True if one interval may stand for both: they differ by at most 3 %.
bool are_alike(const Allowance& a, const Allowance& b) noexcept;

// All parts together. half_filter: half the length of the path filter, s.
SpeedLimit speed_limit(const Allowance& allowance, float half_filter) noexcept;

// The feed override goes up to 200 %: squared, four times.
inline constexpr float kGreatestFeedFactor = 4.0F;

// The fastest that caps and feed allow at any override, mm/s.
inline float greatest_speed(const Allowance& allowance, path::MoveKind kind) noexcept
{
    const bool scaled_up = kind == path::MoveKind::kFeed;
    const float feed = scaled_up ? kGreatestFeedFactor * allowance.feed : allowance.feed;
    return std::sqrt(std::min(allowance.cap, feed));
}

// Squared speed is capped where the centripetal acceleration takes this part of an axis' limit, so
// that some is left to change the speed.
inline constexpr float kCentripetalShare = 0.92F;
// And where v^3 |d3P/ds3| takes this part of its jerk.
inline constexpr float kCurvatureJerkShare = 0.5F;
// Share of a piece that replaces short lines: its bends are long, and more is passed at the cap.
inline constexpr float kSmoothedJerkShare = 0.75F;
// Share of a transition, towards which nothing brakes.
inline constexpr float kTransitionJerkShare = 0.9F;

// The limits of a stretch with such derivatives.
//
//   limits           of the axes.
//   filter_s         length of the path filter, s, > 0: jerk along the path is at most
//                    acceleration/filter_s.
//   max_centripetal  largest |d2P/ds2| v^2, mm/s^2: bounds the deviation by the axis filters.
//   max_speed        mm/s, < 1e12; another bound of the speed.
//
// Each axis keeps  |P'| u + |P''| v^2 <= a  and  |P'| u/filter_s + 3 |P''| v u + |P'''| v^3 <= j.
// Source: docs/numerics.md, "Limits along the path".
Allowance allowance(const LaneDerivatives& derivatives,
                    const MachineLimits& limits,
                    float filter_s,
                    float max_centripetal,
                    float max_speed,
                    float jerk_share = kCurvatureJerkShare) noexcept;

}  // namespace cusp::planner
