// When an axis crosses the middles between steps, within one servo tick.
#pragma once

#include <cmath>

namespace cusp::pulse {

// The position of an axis over a tick, in steps. Time runs from 0 to 1.
struct TickCubic {
    float c0, c1, c2, c3;

    float at(float t) const noexcept { return c0 + t * (c1 + t * (c2 + t * c3)); }
    float slope_at(float t) const noexcept { return c1 + t * (2.0F * c2 + t * 3.0F * c3); }
};

// The travels of the latest ticks, in steps, and the cubic of the last one: through the set points at
// its ends with the slope that the tick before ended with, so that the speed has no jumps.
//
// The slope at the end of a tick is that of the cubic through the last four set points: no later set
// point is waited for, which would delay all stops by a tick. It is exact at constant jerk; where the
// jerk changes by j once in four ticks, the place is off by at most 0.03 j tick^3.
struct TickTravels {
    float now{0};
    float before{0};
    float earlier{0};
    float start_slope{0};
    float end_slope{0};

    // A tick with this travel follows.
    void add(float travel) noexcept
    {
        earlier = before;
        before = now;
        now = travel;
        start_slope = end_slope;
        end_slope = now + (5.0F * (now - before) - 2.0F * (before - earlier)) / 6.0F;
    }
    // The last tick's, from `start` steps.
    TickCubic cubic_from(float start) const noexcept
    {
        return {start, start_slope, 3.0F * now - 2.0F * start_slope - end_slope,
                start_slope + end_slope - 2.0F * now};
    }
};

// Times closer than this, in ticks, are the same: a fiftieth of a pulse tick.
inline constexpr float kCloseTime = 2e-5F;

// A time in [from, 1] at which the cubic is at `level`, within 2e-5 of a tick or 1e-6 of a step.
//
//   rising  whether the cubic comes from below the level.
//
// Precondition: level lies between at(from) and at(1), but for rounding: at the very end of the
// tick the answer is 1.
float crossing_time(TickCubic cubic, float level, float from, bool rising) noexcept;

// The crossings of the middles between steps, one after the other, from the start of a tick on.
class StepTimes {
public:
    StepTimes(const TickCubic& cubic, bool rising) noexcept
        : cubic_{cubic},
          twice_c2_{2.0F * cubic.c2},
          bend_{sharpest_bend(cubic)},
          one_step_{rising ? 1.0F : -1.0F},
          level_{0.5F * one_step_}
    {
    }

    // The time of the next crossing. Precondition: there is one in the tick.
    float next() noexcept
    {
        if (!take_newton_steps()) {
            time_ = crossing_time(cubic_, level_, time_, one_step_ > 0.0F);
        }
        level_ += one_step_;
        return time_;
    }

    // True if from every crossing a single Newton step is provably within kCloseTime of the next:
    // the slope keeps its sign and at least `least`, so a step takes 1 / least at most, and the
    // step misses by bend / (2 least^3) at most. The tenth more is for the times' own errors.
    bool steady() const noexcept
    {
        const float least = std::fabs(cubic_.c1) - bend_;
        return least > 0.0F && 0.55F * bend_ <= kCloseTime * least * least * least;
    }

    // As next(), with the same answer in a fraction of the work. Precondition: steady(), next() has
    // been called, and there is another crossing after this one.
    float next_steady() noexcept
    {
        time_ += (level_ - cubic_.at(time_)) / slope_at(time_);
        level_ += one_step_;
        return time_;
    }

private:
    friend class SteadyLanes;

    // The largest second derivative of the cubic over the tick, without its sign.
    static float sharpest_bend(const TickCubic& cubic) noexcept
    {
        const float at_start = std::fabs(2.0F * cubic.c2);
        const float at_end = std::fabs(2.0F * cubic.c2 + 6.0F * cubic.c3);
        return at_start > at_end ? at_start : at_end;
    }
    float slope_at(float time) const noexcept
    {
        return cubic_.c1 + time * (twice_c2_ + time * 3.0F * cubic_.c3);
    }

    struct NewtonStep {
        float length;
        bool close;  // provably within the error allowed
    };
    // From `time`; `allowed` is an error in ticks. A step misses by at most bend length^2 / 2,
    // divided by the least slope on the way.
    NewtonStep newton_step_from(float time, float allowed) const noexcept
    {
        const float slope = slope_at(time);
        const float length = (level_ - cubic_.at(time)) / slope;
        const float least_slope = std::fabs(slope) - bend_ * std::fabs(length);
        // False for a slope of 0 too, whose step is infinite or none.
        return {length,
                least_slope > 0.0F && 0.5F * bend_ * length * length <= allowed * least_slope};
    }
    // Goes to the crossing in one Newton step or two, where these are close and stay in the tick.
    // Returns whether it did; the time is left alone otherwise.
    bool take_newton_steps() noexcept
    {
        const NewtonStep first = newton_step_from(time_, kCloseTime);
        const float there = time_ + first.length;
        if (!(first.length >= 0.0F && there <= 1.0F)) {
            return false;
        }
        if (first.close) {
            time_ = there;
            return true;
        }
        const NewtonStep second = newton_step_from(there, 0.01F * kCloseTime);
        const float nearer = there + second.length;
        const bool found =
            second.close && slope_at(there) * one_step_ > 0.0F && nearer >= time_ && nearer <= 1.0F;
        time_ = found ? nearer : time_;
        return found;
    }

    TickCubic cubic_;
    float twice_c2_;
    float bend_;
    float one_step_;
    float level_;
    float time_{0.0F};
};

}  // namespace cusp::pulse
