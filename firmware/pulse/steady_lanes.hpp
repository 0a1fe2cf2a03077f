// SteadyLanes: the steady steps of four axes at once, for processors that wait for divisions.
#pragma once

#include <cstdint>

#include "firmware/pulse/step_times.hpp"

namespace cusp::pulse {

// Each lane is the StepTimes that was put into it, with the same operations and so the same bits. A
// step waits for the division of the one before; those of other axes do not.
class SteadyLanes {
public:
    using Times = float __attribute__((vector_size(16)));

    // Precondition: times.steady(); next() has been called.
    void put(unsigned lane, const StepTimes& times) noexcept
    {
        set(lane, times.cubic_, times.one_step_, times.level_, times.time_);
    }
    // Gives back the times of a lane, and lets it rest.
    void take(unsigned lane, StepTimes& times) noexcept
    {
        times.level_ = level_[lane];
        times.time_ = time_[lane];
        rest(lane);
    }

    // As StepTimes::next_steady() of all lanes. Those that rest give 0.
    Times next() noexcept
    {
        const Times position = c0_ + time_ * (c1_ + time_ * (c2_ + time_ * c3_));
        const Times slope = c1_ + time_ * (twice_c2_ + time_ * 3.0F * c3_);
        time_ += (level_ - position) / slope;
        level_ += one_step_;
        return time_;
    }

private:
    void rest(unsigned lane) noexcept { set(lane, {0.0F, 1.0F, 0.0F, 0.0F}, 0.0F, 0.0F, 0.0F); }
    void set(unsigned lane, const TickCubic& cubic, float one_step, float level, float time) noexcept
    {
        c0_[lane] = cubic.c0;
        c1_[lane] = cubic.c1;
        c2_[lane] = cubic.c2;
        c3_[lane] = cubic.c3;
        twice_c2_[lane] = 2.0F * cubic.c2;
        one_step_[lane] = one_step;
        level_[lane] = level;
        time_[lane] = time;
    }

    Times c0_{};
    Times c1_ = Times{} + 1.0F;  // at rest: a division by 1
    Times c2_{};
    Times c3_{};
    Times twice_c2_{};
    Times one_step_{};
    Times level_{};
    Times time_{};
};

}  // namespace cusp::pulse
