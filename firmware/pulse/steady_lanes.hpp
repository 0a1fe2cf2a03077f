// SteadyLanes: the steady steps of four axes at once, for processors that wait for divisions.
#pragma once

#include <cstdint>

#include "firmware/base/pulse_frame.hpp"
#include "firmware/pulse/step_times.hpp"

namespace cusp::pulse {

// Each lane is the StepTimes that was put into it, with the same operations and so the same bits. A
// step waits for the division of the one before; those of other axes do not.
class SteadyLanes {
public:
    using Ticks = std::int32_t __attribute__((vector_size(16)));

    // Precondition: times.steady(); next() has been called.
    void put(unsigned lane, const StepTimes& times) noexcept
    {
        c0_[lane] = times.cubic_.c0;
        c1_[lane] = times.cubic_.c1;
        c2_[lane] = times.cubic_.c2;
        c3_[lane] = times.cubic_.c3;
        twice_c2_[lane] = times.twice_c2_;
        one_step_[lane] = times.one_step_;
        level_[lane] = times.level_;
        time_[lane] = times.time_;
    }
    // Gives back what put() took.
    void take(unsigned lane, StepTimes& times) const noexcept
    {
        times.level_ = level_[lane];
        times.time_ = time_[lane];
    }

    // As StepTimes::next_steady() of all lanes, in pulse ticks as to_pulse_tick() has them. Empty
    // lanes stay at 0.
    Ticks next() noexcept
    {
        const Lanes position = c0_ + time_ * (c1_ + time_ * (c2_ + time_ * c3_));
        const Lanes slope = c1_ + time_ * (twice_c2_ + time_ * 3.0F * c3_);
        return step(position, slope);
    }

    // True if no lane gains or loses speed: then next_even() gives what next() does, sooner.
    bool even() const noexcept
    {
        const Ticks bent = (c2_ != 0.0F) | (c3_ != 0.0F);
        return (bent[0] | bent[1] | bent[2] | bent[3]) == 0;
    }
    Ticks next_even() noexcept { return step(c0_ + time_ * c1_, c1_); }

private:
    using Lanes = float __attribute__((vector_size(16)));

    Ticks step(Lanes position, Lanes slope) noexcept
    {
        time_ += (level_ - position) / slope;
        level_ += one_step_;
        return __builtin_convertvector(time_ * static_cast<float>(kPulseTicksPerFrame) + 0.5F,
                                       Ticks);
    }

    Lanes c0_{};
    Lanes c1_ = Lanes{} + 1.0F;  // an empty lane divides by 1
    Lanes c2_{};
    Lanes c3_{};
    Lanes twice_c2_{};
    Lanes one_step_{};
    Lanes level_{};
    Lanes time_{};
};

}  // namespace cusp::pulse
