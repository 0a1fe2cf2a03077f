// Overlaps of rising length are tried; the best is kept.
#include "firmware/planner/corner_overlap.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::planner {
namespace {

constexpr float kElementTime = 0.8F;     // of the longest a/j
constexpr float kMostOverlap = 1.2F;     // of it
constexpr float kLongestOverlap = 0.1F;  // s
constexpr unsigned kTries = 64;
constexpr float kCostOfJerk = 1.2F;             // of the time in which it is lower
constexpr float kLeastGain = 0.0005F;           // s
constexpr float kPartOfStretch = 1.0F / 12.0F;  // that an element may take
constexpr float kDisjoint = 1.001F;

// The jerk of an axis that the bends of a side add after a time from rest.
float bend_jerk(const LaneDerivatives& q, float jerk, float time) noexcept
{
    const float speed = 0.5F * jerk * time * time;
    const float second = norm(q.second);
    const float third = std::max(norm(q.third), second * second);
    return 3.5F * second * speed * jerk * time + third * speed * speed * speed;
}

// Distance of a side from the programmed path, mm, up to so much travel from the corner. It and the cut are
// not greatest at once, nor are both sides': each is convex in the time from its end of the overlap.
float departure_within(const CornerSide& side, float travel) noexcept
{
    if (travel > side.lean.length) {
        return side.departure;
    }
    const float second = norm(side.end.second);
    const float third = std::max(norm(side.end.third), second * second);
    return std::min(side.departure,
                    travel * (side.lean.slope + travel * (0.5F * second + travel * third / 6.0F)));
}

float longest_ramp(const MachineLimits& limits) noexcept
{
    return greatest(0.0F, quotient(to_lanes(limits.acceleration), to_lanes(limits.jerk)));
}

// Mean of (h + t)^3/6 under the axis filters, 0 where h + t < 0: h^3/6 + h (a^2 + b^2)/24, and what
// the cut-off adds where they reach farther than h. h in s.
float mean_cube(float h, AxisFilter filter) noexcept
{
    const float first = static_cast<float>(filter.first) * kServoTick;
    const float second = static_cast<float>(filter.second) * kServoTick;
    const float beyond = std::max(0.0F, 0.5F * (first + second) - h);
    const float square = beyond * beyond;
    return h * h * h / 6.0F + h * (first * first + second * second) / 24.0F +
           square * square / (24.0F * first);
}

}  // namespace

StopChoice full_stop(const MachineLimits& limits) noexcept
{
    return {kElementTime * longest_ramp(limits), 1};
}

CornerOverlap corner_overlap(const CornerSide& before,
                             const CornerSide& after,
                             const MachineLimits& limits,
                             AxisFilter filter,
                             float deviation) noexcept
{
    if (deviation <= 0) {
        return {0, false, full_stop(limits)};
    }
    const LaneVec jerk = to_lanes(limits.jerk);
    const LaneVec tiny = all_lanes(1e-9F);
    const LaneVec inverse = quotient(all_lanes(1.0F), jerk);
    const float braking =
        least(kUnlimited, quotient(jerk, larger(magnitude(before.end.first), tiny)));
    const float speeding =
        least(kUnlimited, quotient(jerk, larger(magnitude(after.end.first), tiny)));
    const LaneVec one = before.end.first * braking;
    const LaneVec other = after.end.first * speeding;
    const float least_jerk = least(kUnlimited, jerk);
    const float longest = longest_ramp(limits);
    const float signed_demand = greatest(0.0F, product(magnitude(one + other), inverse));
    const float bends = norm(before.end.second) + norm(after.end.second);

    CornerOverlap best{0, false, full_stop(limits)};
    best.disjoint = bends <= 0 &&
                    greatest(0.0F, product(magnitude(one) + magnitude(other), inverse)) < kDisjoint;
    const float room = best.disjoint ? std::min(before.block, after.block)
                                     : kPartOfStretch * std::min(before.length, after.length);
    const float most = std::min(kMostOverlap * longest, kLongestOverlap);
    float greatest_gain = kLeastGain;
    for (unsigned i = 1; i <= kTries; ++i) {
        const float time = most * static_cast<float>(i) / kTries;
        const float added =
            bend_jerk(before.end, braking, time) + bend_jerk(after.end, speeding, time);
        const float share = 1.0F / std::max(1.0F, signed_demand + added / least_jerk);
        const float cut = share * norm(other - one) * mean_cube(0.5F * time, filter);
        const float way = share * std::max(braking, speeding) * time * time * time / 6.0F;
        const float departure =
            std::max(departure_within(before, way), departure_within(after, way));
        if (cut + departure > deviation || way > room) {
            break;
        }
        const float lowered = time + kServoTick;
        const float gain = time - kCostOfJerk * (1.0F - share) * lowered *
                                      (1.0F - 0.5F * share * lowered / longest);
        if (gain > greatest_gain) {
            greatest_gain = gain;
            best.time = time;
            best.stop = share < 1 ? StopChoice{lowered, share} : full_stop(limits);
        }
    }
    return best;
}

}  // namespace cusp::planner
