// The turns of the axes, and what follows each.
#include "firmware/machine/backlash.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::machine {
namespace {

constexpr float kNanometresPerMillimetre = 1e6F;
constexpr auto kTicksPerSecond = static_cast<float>(kServoTicksPerSecond);

// A way of length 1 in a time of 1, from rest to rest: jerk 32 for a quarter, -32 for a half, 32 again. Its
// greatest speed is 2, its greatest acceleration 8.
constexpr float kJerk = 32;
constexpr float kAcceleration = 8;
constexpr float kSpeed = 2;
float smooth_step(float time) noexcept
{
    constexpr float kQuarter = 0.25F;
    constexpr float kHalf = 0.5F;
    constexpr float kSixthOfJerk = kJerk / 6;
    if (time < kQuarter) {
        return kSixthOfJerk * time * time * time;
    }
    if (time > 1 - kQuarter) {
        const float left = 1 - time;
        return 1 - kSixthOfJerk * left * left * left;
    }
    const float of_middle = time - kHalf;
    return kHalf + of_middle * (kSpeed - kSixthOfJerk * of_middle * of_middle);
}

// Real root of a positive number by Newton's method from above: at most 1e-6 too great.
float cube_root(float value) noexcept
{
    constexpr unsigned kMostRounds = 64;
    float root = std::max(value, 1.0F);
    for (unsigned i = 0; i < kMostRounds; ++i) {
        const float next = (2 * root + value / (root * root)) / 3;
        if (next >= root) {
            break;
        }
        root = next;
    }
    return root * (1 + 1e-6F);
}

// The shortest time that holds the shares, s.
float take_up_time(float play, float speed, float acceleration, float jerk) noexcept
{
    const float by_speed = kSpeed * play / (Backlash::kSpeedShare * speed);
    const float by_acceleration =
        std::sqrt(kAcceleration * play / (Backlash::kShare * acceleration));
    const float by_jerk = cube_root(kJerk * play / (Backlash::kShare * jerk));
    return std::max({by_speed, by_acceleration, by_jerk});
}

}  // namespace

MachineLimits Backlash::left_of(const MachineLimits& limits, const AxisVecf& play) noexcept
{
    MachineLimits left = limits;
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        if (play[axis] > 0) {
            left.velocity[axis] *= 1 - kSpeedShare;
            left.acceleration[axis] *= 1 - kShare;
            left.jerk[axis] *= 1 - kShare;
        }
    }
    left.settle_lacking_axis();
    return left;
}

void Backlash::configure(const AxisVecf& play, const MachineLimits& limits) noexcept
{
    any_ = false;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        Axis& axis = axes_[i];
        const std::int8_t taken = axis.taken;
        axis = Axis{};
        axis.side = taken;
        axis.taken = taken;
        if (play[i] <= 0) {
            continue;
        }
        any_ = true;
        axis.play = static_cast<std::int32_t>(play[i] * kNanometresPerMillimetre + 0.5F);
        const float time =
            take_up_time(play[i], limits.velocity[i], limits.acceleration[i], limits.jerk[i]);
        axis.length = static_cast<std::uint32_t>(time * kTicksPerSecond) + 1;
        axis.step = 1.0F / static_cast<float>(axis.length);
    }
    busy_.store(false, std::memory_order_release);
}

void Backlash::rest(Position at) noexcept
{
    for (unsigned i = 0; i < kAxisCount; ++i) {
        Axis& axis = axes_[i];
        // The rest of a take-up that was cut stays to be taken up.
        axis.to -= axis.at;
        axis.at = 0;
        axis.done = 0;
        axis.side = axis.taken;
        axis.extreme = at[i];
        axis.way = at[i];
    }
    busy_.store(false, std::memory_order_release);
}

// Takes the other side where the way has turned; while an earlier turn is being taken up the way may turn
// back before that.
inline bool Backlash::turns(Axis& axis, std::int64_t way) noexcept
{
    const std::int64_t beyond = way - axis.extreme;
    if (axis.side == 0) {
        axis.side = static_cast<std::int8_t>(beyond > kTurn ? 1 : beyond < -kTurn ? -1 : 0);
        axis.taken = axis.side;
        axis.extreme = axis.side == 0 ? axis.extreme : way;
        return false;
    }
    if (axis.side > 0 ? beyond >= 0 : beyond <= 0) {
        axis.extreme = way;
    } else if (axis.side > 0 ? beyond < -kTurn : beyond > kTurn) {
        axis.side = static_cast<std::int8_t>(-axis.side);
        axis.extreme = way;
    }
    if (axis.side == axis.taken || axis.done != 0) {
        return false;
    }
    axis.taken = axis.side;
    axis.to += axis.side * axis.play;
    return true;
}

// `begins`: the axis turns in this tick. What a stop has left over begins with the way.
inline void Backlash::advance(Axis& axis, std::int64_t way, bool begins) noexcept
{
    const bool goes_on = begins || way != axis.way;
    axis.way = way;
    if (axis.done == 0) {
        if (axis.at == axis.to || !goes_on) {
            return;
        }
        axis.from = axis.at;
    }
    ++axis.done;
    if (axis.done >= axis.length) {
        axis.at = axis.to;
        axis.done = 0;
        return;
    }
    const float part = smooth_step(static_cast<float>(axis.done) * axis.step);
    const auto distance = static_cast<float>(axis.to - axis.from);
    axis.at = axis.from + static_cast<std::int32_t>(part * distance);
}

Position Backlash::follow(Position way) noexcept
{
    if (!any_) {
        return way;
    }
    Position motors = way;
    bool busy = false;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        Axis& axis = axes_[i];
        if (axis.play == 0) {
            continue;
        }
        advance(axis, way[i], turns(axis, way[i]));
        motors[i] += axis.at;
        busy = busy || axis.done != 0;
    }
    busy_.store(busy, std::memory_order_release);
    return motors;
}

void Backlash::stop() noexcept
{
    for (Axis& axis : axes_) {
        axis.done = 0;
        axis.side = axis.taken;
    }
    busy_.store(false, std::memory_order_release);
}

}  // namespace cusp::machine
