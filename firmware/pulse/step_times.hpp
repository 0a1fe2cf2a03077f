// When an axis crosses the middles between steps, within one servo tick.
#pragma once

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

// A time in [from, 1] at which the cubic is at `level`, within 2e-5 of a tick or 1e-6 of a step.
//
//   rising  whether the cubic comes from below the level.
//
// Precondition: level lies between at(from) and at(1), but for rounding: at the very end of the
// tick the answer is 1.
float crossing_time(const TickCubic& cubic, float level, float from, bool rising) noexcept;

}  // namespace cusp::pulse
