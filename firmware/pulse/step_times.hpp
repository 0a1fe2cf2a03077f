// When an axis crosses the middles between steps, within one servo tick.
#pragma once

#include <cmath>

namespace cusp::pulse {

// The position of an axis over a tick, in steps: the cubic through the set points at its ends with
// the mean slopes of the neighbouring ticks (Catmull and Rom, 1974). Time runs from 0 to 1.
struct TickCubic {
    float c0, c1, c2, c3;

    float at(float t) const noexcept { return c0 + t * (c1 + t * (c2 + t * c3)); }
    float slope_at(float t) const noexcept { return c1 + t * (2.0F * c2 + t * 3.0F * c3); }
};

// The cubic from `start` steps that travels `before`, `now` and `after` steps in the tick before,
// this one, and the next.
TickCubic tick_cubic(float start, float before, float now, float after) noexcept;

// Times closer than this, in ticks, are the same: a fiftieth of a pulse tick.
inline constexpr float kCloseTime = 2e-5F;

// The largest second derivative of the cubic over the tick, without its sign.
inline float sharpest_bend(const TickCubic& cubic) noexcept
{
    const float at_start = std::fabs(2.0F * cubic.c2);
    const float at_end = std::fabs(2.0F * cubic.c2 + 6.0F * cubic.c3);
    return at_start > at_end ? at_start : at_end;
}

// Goes from `time`, where the cubic is short of `level`, to the crossing in one Newton step, where
// that is provably within kCloseTime of it: the step misses by at most bend step^2 / 2, divided by
// the least slope on the way. Returns whether it did; `time` is left alone otherwise.
inline bool take_newton_step(const TickCubic& cubic, float bend, float level, float& time) noexcept
{
    const float slope = cubic.slope_at(time);
    const float step = (level - cubic.at(time)) / slope;
    const float least_slope = std::fabs(slope) - bend * step;
    // False for a slope of 0 too, whose step is infinite or none.
    const bool close = step >= 0.0F && time + step <= 1.0F && least_slope > 0.0F &&
                       0.5F * bend * step * step <= kCloseTime * least_slope;
    if (close) {
        time += step;
    }
    return close;
}

// A time in [from, 1] at which the cubic is at `level`, within 2e-5 of a tick or 1e-6 of a step.
//
//   rising  whether the cubic comes from below the level.
//
// Precondition: level lies between at(from) and at(1), but for rounding: at the very end of the
// tick the answer is 1.
float crossing_time(const TickCubic& cubic, float level, float from, bool rising) noexcept;

}  // namespace cusp::pulse
