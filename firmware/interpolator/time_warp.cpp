// A slope of the rate is aimed at, and taken back as soon as the plan ahead demands it.
#include "firmware/interpolator/time_warp.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "firmware/base/path_units.hpp"
#include "firmware/planner/station.hpp"

namespace cusp::interpolator {
namespace {

constexpr float kPartOfJerk = 0.8F;
constexpr float kPartOfAcceleration = 0.98F;
constexpr float kMostAcceleration = 0.999F;
constexpr float kPartNear = 0.98F;
constexpr float kPartAhead = 0.85F;
constexpr float kPartOfDistance = 0.7F;  // of the slope that could still be taken back
constexpr float kTimeOfRest = 0.12F;     // of a/j: the last of the way is exponential
constexpr float kTimeOfRise = 0.4F;
constexpr float kLeastTimeOfRest = 2 * kServoTick;
constexpr float kReachOfRamp = 2.0F;  // of a/j
constexpr float kLeastReach = 0.03F;  // s
constexpr unsigned kTries = 4;        // of slopes
constexpr float kLessWanted = 0.45F;  // from one to the next
constexpr unsigned kStepsAhead = 24;  // of the reach
constexpr float kPartOfRelief = 0.8F;
constexpr float kLongestSecondFilter = 2 * kServoTick;
constexpr float kWayToTarget = 1.5F;  // of the distance over the slope
constexpr float kLeastSpeed = 1e-7F;  // of |V|/a, s
constexpr float kLeastLeft = 1e-6F;
constexpr float kLeastRate = 1e-3F;
constexpr float kMostBend = 1e6F;  // 1/s^2
constexpr std::size_t kPiecesOfTick = 2;
constexpr float kNearRate = 2e-5F;   // of the target: it is reached
constexpr float kNearSlope = 1e-3F;  // 1/s

// The jerks that a piece leaves for a change of the rate's slope: upwards, in the direction of V, or
// downwards. As r^3 J a jerk the other way is counted by a part: r may fall meanwhile.
LaneVec jerk_left(const WarpBounds& plan, float rate, bool up) noexcept
{
    const LaneVec along = (up ? plan.rising : plan.falling * -1.0F) * (rate * rate * rate);
    const LaneVec used = larger(along, along * kPartOfRelief) + plan.joint * rate;
    // Both are within the plan's share at each place, if not the greatest of a piece.
    const LaneVec most = all_lanes(planner::kPlanShare * rate);
    return larger(all_lanes(1.0F) - smaller(used, most), all_lanes(kLeastLeft));
}

// A/a that a slope makes jerk of, 3 r r' A, in such a direction, as a magnitude; 0 where it relieves.
LaneVec acceleration_against(const WarpBounds& plan, bool brakes, bool up) noexcept
{
    const LaneVec against = brakes == up ? plan.braking * -1.0F : plan.speeding;
    return larger(against, all_lanes(kLeastLeft));
}

LaneVec speed_of(const WarpBounds& plan) noexcept
{
    return larger(plan.speed, all_lanes(kLeastSpeed));
}

}  // namespace

void TimeWarp::set_limits(const MachineLimits& limits) noexcept
{
    ramp_ = quotient(to_lanes(limits.acceleration), to_lanes(limits.jerk));
    longest_ramp_ = greatest(0.0F, ramp_);
    reach_ = std::max(kReachOfRamp * longest_ramp_, kLeastReach);
}

// Share of the accelerations that a piece uses in the direction of a slope. The acceleration of a joint falls with
// the rate, not with its square: it is at most the joint's jerk times the axes' second filter.
LaneVec TimeWarp::acceleration_used(const WarpBounds& plan, float rate, bool brakes) const noexcept
{
    const float square = rate * rate;
    const LaneVec along = brakes ? plan.braking * -square : plan.speeding * square;
    const LaneVec more = quotient(plan.joint * (kLongestSecondFilter * (rate - square)), ramp_);
    return smaller(along + more, all_lanes(planner::kPlanShare * rate));
}

// r'' that is left to take a slope back.
float TimeWarp::back_bend(const WarpBounds& plan, float rate, bool brakes) const noexcept
{
    const LaneVec left = jerk_left(plan, rate, brakes) * kPartOfJerk;
    return least(kMostBend, quotient(left, product(speed_of(plan), ramp_)));
}

// The slope of the rate, 1/s, that may be aimed at.
float TimeWarp::wanted_slope(Span<const WarpBounds> ahead) const noexcept
{
    const bool brakes = target_ < rate_;
    const float distance = std::fabs(rate_ - target_);
    const float half_way = std::min(0.5F * (rate_ + target_), rate_);
    float most =
        distance / std::max((brakes ? kTimeOfRest : kTimeOfRise) * longest_ramp_, kLeastTimeOfRest);
    // The slope is taken back before the target: over the whole distance by the jerk left at this rate, or
    // over half of it by what is left further on.
    float way = 0;
    for (const WarpBounds& plan : ahead) {
        const float bend =
            std::max(back_bend(plan, rate_, brakes), 0.5F * back_bend(plan, half_way, brakes));
        most = std::min(most, kPartOfDistance * std::sqrt(2.0F * bend * distance));
        way += &plan != ahead.begin() ? plan.time : 0.0F;
        if (way * most > kWayToTarget * distance) {
            break;
        }
    }
    for (const WarpBounds& plan : ahead) {
        const LaneVec used = acceleration_used(plan, rate_, brakes);
        const LaneVec left = larger(all_lanes(1.0F) - used, all_lanes(0.0F));
        most = least(most, quotient(left * kPartOfAcceleration, speed_of(plan)));
        for (const bool up : {false, true}) {
            const LaneVec turn = product(acceleration_against(plan, brakes, up), ramp_) *
                                 (3.0F * std::max(rate_, kLeastRate));
            most = least(most, quotient(jerk_left(plan, rate_, up) * kPartOfJerk, turn));
        }
    }
    return brakes ? -most : most;
}

// True if the axes have the acceleration for a slope.
bool TimeWarp::may_slope(const WarpBounds& plan, float rate, float slope) const noexcept
{
    const LaneVec used = acceleration_used(plan, rate, slope < 0);
    return greatest(0.0F, used + speed_of(plan) * std::fabs(slope)) <= kMostAcceleration;
}

// r'' that a piece leaves at a slope, upwards or downwards; less than 0 where the slope itself is too much.
float TimeWarp::bend_left(
    const WarpBounds& plan, float rate, float slope, bool up, float part) const noexcept
{
    const LaneVec turn = product(acceleration_against(plan, slope < 0, up), ramp_) *
                         (3.0F * rate * std::fabs(slope));
    const LaneVec left = jerk_left(plan, rate, up) * part - turn;
    return least(kMostBend, quotient(left, product(speed_of(plan), ramp_)));
}

// r'' that the pieces of a pass leave.
float TimeWarp::bend_of_pass(Span<const WarpBounds> ahead,
                             const Pass& pass,
                             float rate,
                             float slope) const noexcept
{
    float bend = kMostBend;
    const std::size_t first = pass.first > 0 ? pass.first - 1 : 0;
    for (std::size_t i = first; i <= pass.last + 1 && i < ahead.size() && bend > 0; ++i) {
        bend = may_slope(ahead[i], rate, slope)
                   ? std::min(bend, bend_left(ahead[i], rate, slope, slope < 0, kPartAhead))
                   : 0.0F;
    }
    return bend;
}

// True if the slope can be taken back to 0 within the plan ahead, and before the target where it leads
// there: it is played through. Where the tool is meanwhile is known within its least and its
// greatest rate.
bool TimeWarp::can_let_be(Span<const WarpBounds> ahead, float slope) const noexcept
{
    const bool rises = slope > 0;
    const float goal = rises ? (target_ > rate_ ? target_ : 1.0F) : std::min(target_, rate_);
    const float step = std::max(reach_ / kStepsAhead, kServoTick);
    float rate = rate_;
    float left = std::fabs(slope);
    float latest = 0;
    float soonest = 0;
    Pass pass{1, 1, ahead[1].time, ahead[1].time};
    for (unsigned i = 0; i < 2 * kStepsAhead && left > 0; ++i) {
        const float most = rises ? std::min(rate + left * step, 1.0F) : rate;
        const float least_rate = rises ? rate : std::max(rate - left * step, 0.0F);
        soonest += most * step;
        while (pass.first + 1 < ahead.size() && pass.end_of_first <= latest) {
            ++pass.first;
            pass.end_of_first += ahead[pass.first].time;
        }
        while (pass.last + 1 < ahead.size() && pass.end_of_last <= soonest) {
            ++pass.last;
            pass.end_of_last += ahead[pass.last].time;
        }
        latest += least_rate * step;
        const float bend = bend_of_pass(ahead, pass, most, rises ? left : -left);
        if (bend <= 0 || pass.end_of_last <= soonest) {
            return false;
        }
        const float after = left - bend * step;
        const float way = after > 0 ? 0.5F * (left + after) * step : 0.5F * left * left / bend;
        rate += rises ? way : -way;
        if (rises ? rate > goal : rate < goal) {
            return false;
        }
        left = after;
    }
    return left <= 0;
}

float TimeWarp::advance(Span<const WarpBounds> ahead) noexcept
{
    if (settled()) {
        free_ = rate_ >= 1;
        return rate_ * kServoTick;
    }
    float most_up = kMostBend;
    float most_down = kMostBend;
    const std::size_t near = ahead[1].time < kServoTick ? kPiecesOfTick + 1 : kPiecesOfTick;
    for (std::size_t i = 0; i < std::min(ahead.size(), near); ++i) {
        most_up = std::min(most_up, bend_left(ahead[i], rate_, slope_, true, kPartNear));
        most_down = std::min(most_down, bend_left(ahead[i], rate_, slope_, false, kPartNear));
    }
    most_up = std::max(most_up, 0.0F);
    most_down = std::max(most_down, 0.0F);
    float wanted = wanted_slope(ahead);
    const auto bend_to = [&](float slope) {
        return std::clamp((slope - slope_) / kServoTick, -most_down, most_up);
    };
    float bend = bend_to(wanted);
    for (unsigned i = 0; !can_let_be(ahead, slope_ + bend * kServoTick); ++i) {
        wanted *= i + 1 < kTries ? kLessWanted : 0.0F;
        bend = bend_to(wanted);
        if (i == kTries) {
            break;
        }
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
    return std::clamp(time, 0.0F, kServoTick);
}

}  // namespace cusp::interpolator
