// A slope of the rate is aimed at, and taken back as soon as the plan ahead demands it.
#include "firmware/interpolator/time_warp.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "firmware/base/path_units.hpp"

namespace cusp::interpolator {
namespace {

constexpr float kPartOfJerk = 0.8F;
constexpr float kPartOfAcceleration = 0.98F;
constexpr float kPartNear = 0.96F;
constexpr float kPartOfDistance = 0.7F;  // of the slope that could still be taken back
constexpr float kTimeOfRest = 0.12F;     // of a/j: the last of the way is exponential
constexpr float kLeastTimeOfRest = 2 * kServoTick;
constexpr float kReachOfRamp = 2.0F;  // of a/j
constexpr float kLeastReach = 0.03F;  // s
constexpr float kLeastSpeed = 1e-7F;  // of |V|/a, s
constexpr float kLeastLeft = 1e-6F;
constexpr float kLeastRate = 1e-3F;
constexpr float kMostBend = 1e6F;  // 1/s^2
constexpr std::size_t kPiecesOfTick = 2;
constexpr float kNearRate = 2e-5F;   // of the target: it is reached
constexpr float kNearSlope = 1e-3F;  // 1/s

LaneVec jerk_left(const WarpBounds& plan, float rate) noexcept
{
    return larger(all_lanes(1.0F) - plan.jerk * (rate * rate * rate), all_lanes(kLeastLeft));
}

LaneVec speed_of(const WarpBounds& plan) noexcept
{
    return larger(plan.speed, all_lanes(kLeastSpeed));
}

// Greatest |A|/a.
LaneVec acceleration_of(const WarpBounds& plan) noexcept
{
    return larger(larger(magnitude(plan.braking), magnitude(plan.speeding)), all_lanes(kLeastLeft));
}

}  // namespace

void TimeWarp::set_limits(const MachineLimits& limits) noexcept
{
    ramp_ = quotient(to_lanes(limits.acceleration), to_lanes(limits.jerk));
    longest_ramp_ = greatest(0.0F, ramp_);
    reach_ = std::max(kReachOfRamp * longest_ramp_, kLeastReach);
}

// The slope of the rate, 1/s, that may be aimed at.
float TimeWarp::wanted_slope(Span<const WarpBounds> ahead) const noexcept
{
    float most_bend = kMostBend;
    for (const WarpBounds& plan : ahead) {
        const LaneVec left = jerk_left(plan, rate_) * kPartOfJerk;
        most_bend = least(most_bend, quotient(left, product(speed_of(plan), ramp_)));
    }
    const bool brakes = target_ < rate_;
    const float square = rate_ * rate_;
    const float distance = std::fabs(rate_ - target_);
    float most = std::min(kPartOfDistance * std::sqrt(2.0F * most_bend * distance),
                          distance / std::max(kTimeOfRest * longest_ramp_, kLeastTimeOfRest));
    for (const WarpBounds& plan : ahead) {
        const LaneVec used = brakes ? plan.braking * -square : plan.speeding * square;
        const LaneVec left = larger(all_lanes(1.0F) - used, all_lanes(0.0F));
        most = least(most, quotient(left * kPartOfAcceleration, speed_of(plan)));
        const LaneVec turn =
            product(acceleration_of(plan), ramp_) * (3.0F * std::max(rate_, kLeastRate));
        most = least(most, quotient(jerk_left(plan, rate_) * kPartOfJerk, turn));
    }
    return brakes ? -most : most;
}

// r'' that a piece leaves at a slope; less than 0 where the slope itself is too much.
float TimeWarp::bend_left(const WarpBounds& plan, float rate, float slope) const noexcept
{
    const LaneVec turn = product(acceleration_of(plan), ramp_) * (3.0F * rate * slope);
    const LaneVec left = jerk_left(plan, rate) * kPartNear - turn;
    const float bend = least(kMostBend, quotient(left, product(speed_of(plan), ramp_)));
    return bend;
}

// True if the slope can be taken back to 0 within the plan ahead and before the target. A piece is passed with what it and
// its neighbours leave, in its own time at least, for the rate is at most 1.
bool TimeWarp::can_let_be(Span<const WarpBounds> ahead, float slope) const noexcept
{
    const float rate = slope < 0 ? rate_ : 1.0F;
    float left = std::fabs(slope);
    float least_bend = kMostBend;
    for (std::size_t i = 0; i < ahead.size(); ++i) {
        float bend = bend_left(ahead[i], rate, left);
        bend = i > 0 ? std::min(bend, bend_left(ahead[i - 1], rate, left)) : bend;
        bend = i + 1 < ahead.size() ? std::min(bend, bend_left(ahead[i + 1], rate, left)) : bend;
        if (bend < 0) {
            return false;
        }
        least_bend = std::min(least_bend, bend);
        // The tool may be at the end of the first.
        left -= i > 0 ? bend * ahead[i].time : 0.0F;
        if (left <= 0) {
            return slope * slope <= 2.0F * least_bend * std::fabs(rate_ - target_);
        }
    }
    return false;
}

float TimeWarp::advance(Span<const WarpBounds> ahead) noexcept
{
    changes_ = target_ < rate_ || rate_ < target_ || slope_ < 0 || slope_ > 0;
    if (!changes_) {
        return rate_ * kServoTick;
    }
    float most = kMostBend;
    for (std::size_t i = 0; i < std::min(ahead.size(), kPiecesOfTick); ++i) {
        most = std::min(most, bend_left(ahead[i], rate_, std::fabs(slope_)));
    }
    most = std::max(most, 0.0F);
    const float wanted = wanted_slope(ahead);
    const auto bend_to = [&](float slope) {
        return std::clamp((slope - slope_) / kServoTick, -most, most);
    };
    float bend = bend_to(wanted);
    if (!can_let_be(ahead, slope_ + bend * kServoTick)) {
        bend = bend_to(0.0F);
    }
    const float to = rate_ + kServoTick * (slope_ + 0.5F * kServoTick * bend);
    const float time =
        kServoTick * (rate_ + kServoTick * (0.5F * slope_ + kServoTick * bend * (1.0F / 6.0F)));
    slope_ += bend * kServoTick;
    rate_ = std::clamp(to, 0.0F, 1.0F);
    if (std::fabs(rate_ - target_) < kNearRate && std::fabs(slope_) < kNearSlope) {
        rate_ = target_;
        slope_ = 0;
    }
    return std::max(time, 0.0F);
}

}  // namespace cusp::interpolator
