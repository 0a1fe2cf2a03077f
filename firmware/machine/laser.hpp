// Laser: the power of a laser in every servo tick (setting 32).
//
//   the interpolator is on a move, with its power -> the filters delay the motion, so the power waits
//   the set point moves                         -> its true speed makes the power of that tick
//   its pulses play from the next tick on       -> so does the duty cycle
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "firmware/base/vec.hpp"
#include "firmware/machine/accessories.hpp"
#include "firmware/machine/settings.hpp"
#include "firmware/path/laser_power.hpp"

namespace cusp::machine {

// Context: servo tick, but for configure() and set_override(): main loop.
class Laser {
public:
    // No tick runs meanwhile.
    void configure(const Settings& settings) noexcept;
    void set_override(unsigned percent) noexcept
    {
        override_.store(static_cast<float>(percent) * 0.01F, std::memory_order_relaxed);
    }
    bool on() const noexcept { return on_; }

    // Once a tick.
    //
    //   power  of the block that the interpolator is on
    //   stands true if the plan did not move; what it begins then is not delayed: the filters hold
    //          less than a nanometre of what was before
    //   delay  ticks until the set points are there, at most kLongestDelay
    //   moved  nm, by the set point in this tick
    void tick(path::LaserPower power, bool stands, unsigned delay, Position moved) noexcept;

    // Duty cycle, 0 to kFullDuty, and spindle speed, rpm, of the latest set point.
    std::uint16_t duty() const noexcept { return duty_; }
    float speed() const noexcept { return speed_.load(std::memory_order_relaxed); }

    static constexpr unsigned kLongestDelay = 127;

private:
    bool on_{false};
    DutyLaw law_{Settings{}};
    std::atomic<float> override_{1};
    std::atomic<float> speed_{0};
    std::uint16_t duty_{0};
    std::array<path::LaserPower, kLongestDelay + 1> powers_{};
    unsigned latest_{0};  // place in powers_
    bool stood_{true};
};

}  // namespace cusp::machine
