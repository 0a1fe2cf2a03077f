// SpindlePulses: the spindle's pulses, made by a channel of a timer, at any rate and duty cycle.
//
// The timers are those that nothing else of this folder takes: 3, 4, 9 and 12, and of 1 and 8 the one that
// asks for no step pulses. RM0090 sections 17 to 19; alternate functions from the data sheets' tables,
// alike on all chips of the family that have the timer.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/panel.hpp"
#include "hal/stm32f4/peripheral_clocks.hpp"
#include "hal/stm32f4/pins.hpp"

namespace cusp::hal::stm32f4 {

// A channel, 1 to 4, of a timer, on a pin that has it.
struct PulsePin {
    Pin pin;
    unsigned channel{0};
    unsigned timer{3};
};

struct PulseTimer {
    unsigned number;
    unsigned function;   // alternate function of its pins
    bool fast;           // on the fast bus, APB2
    unsigned clock_bit;  // of RCC_APB1ENR, or of RCC_APB2ENR where it is fast
    bool gated;          // its outputs need MOE of BDTR
};
inline constexpr std::array<PulseTimer, 6> kPulseTimers{{{1, 1, true, 0, true},
                                                         {3, 2, false, 1, false},
                                                         {4, 2, false, 2, false},
                                                         {8, 3, true, 1, true},
                                                         {9, 3, true, 16, false},
                                                         {12, 9, false, 6, false}}};

// Null: it makes no pulses for a spindle.
constexpr const PulseTimer* pulse_timer(unsigned number) noexcept
{
    for (const PulseTimer& timer : kPulseTimers) {
        if (timer.number == number) {
            return &timer;
        }
    }
    return nullptr;
}

// True if the pin has that channel of that timer.
constexpr bool has_channel(const PulsePin& wanted) noexcept
{
    constexpr std::array<PulsePin, 40> kPlaces{{
        {{'A', 8}, 1, 1}, {{'A', 9}, 2, 1},  {{'A', 10}, 3, 1},  {{'A', 11}, 4, 1},
        {{'E', 9}, 1, 1}, {{'E', 11}, 2, 1}, {{'E', 13}, 3, 1},  {{'E', 14}, 4, 1},
        {{'A', 6}, 1, 3}, {{'B', 4}, 1, 3},  {{'C', 6}, 1, 3},   {{'A', 7}, 2, 3},
        {{'B', 5}, 2, 3}, {{'C', 7}, 2, 3},  {{'B', 0}, 3, 3},   {{'C', 8}, 3, 3},
        {{'B', 1}, 4, 3}, {{'C', 9}, 4, 3},  {{'B', 6}, 1, 4},   {{'D', 12}, 1, 4},
        {{'B', 7}, 2, 4}, {{'D', 13}, 2, 4}, {{'B', 8}, 3, 4},   {{'D', 14}, 3, 4},
        {{'B', 9}, 4, 4}, {{'D', 15}, 4, 4}, {{'C', 6}, 1, 8},   {{'C', 7}, 2, 8},
        {{'C', 8}, 3, 8}, {{'C', 9}, 4, 8},  {{'I', 5}, 1, 8},   {{'I', 6}, 2, 8},
        {{'I', 7}, 3, 8}, {{'I', 2}, 4, 8},  {{'A', 2}, 1, 9},   {{'E', 5}, 1, 9},
        {{'A', 3}, 2, 9}, {{'E', 6}, 2, 9},  {{'B', 14}, 1, 12}, {{'B', 15}, 2, 12},
    }};
    for (const PulsePin& place : kPlaces) {
        if (place.pin.port == wanted.pin.port && place.pin.number == wanted.pin.number &&
            place.channel == wanted.channel && place.timer == wanted.timer) {
            return true;
        }
    }
    return false;
}

// The clock that the timer needs.
constexpr PeripheralClocks clocks_of(const PulsePin& pulses) noexcept
{
    const PulseTimer& timer = *pulse_timer(pulses.timer);
    const std::uint32_t bit = 1U << timer.clock_bit;
    return {0, timer.fast ? 0U : bit, timer.fast ? bit : 0U};
}

// `Place` has kPulses, a PulsePin, and kFastTimerHz and kSlowTimerHz: what timers of the two buses count.
template <class Chip, class Place>
class SpindlePulses {
public:
    // The pin goes to the timer; the pulses have the rate and duty that were set last.
    static void start() noexcept
    {
        constexpr std::uint32_t kPulseMode = 6U << 4U | 1U << 3U;
        (kPulses.channel <= 2 ? timer().ccmr1 : timer().ccmr2)
            .write(kPulseMode << (kPulses.channel % 2 == 0 ? 8U : 0U));
        if constexpr (kTimer.gated) {
            timer().bdtr.write(1U << 15U);
        }
        timer().egr.write(1);
        timer().cr1.write(1U << 7U | 1U);
        set_pin_function(Chip::port(kPulses.pin.port), kPulses.pin.number, kTimer.function);
    }

    // hz >= 1; the greatest prescaler gives 0.02 Hz.
    static void set_rate(std::uint32_t hz) noexcept
    {
        constexpr std::uint32_t kTimerHz = kTimer.fast ? Place::kFastTimerHz : Place::kSlowTimerHz;
        constexpr std::uint32_t kMostCounts = 65536;
        if (hz == hz_) {
            return;
        }
        hz_ = hz;
        const std::uint32_t counts = kTimerHz / hz;
        const std::uint32_t scale = (counts + kMostCounts - 1) / kMostCounts;
        period_ = counts / scale;
        timer().psc.write(scale - 1);
        timer().arr.write(period_ - 1);
        timer().egr.write(1);
    }

    // From the next pulse on, with the polarity at once. duty: 0 to kFullDuty; what is not 0 gives pulses.
    // Context: any; bounded time.
    static void set_duty(std::uint16_t duty, bool inverted) noexcept
    {
        timer().ccer.write((inverted ? 3U : 1U) << 4 * (kPulses.channel - 1));
        set_duty(duty);
    }
    static void set_duty(std::uint16_t duty) noexcept
    {
        compare().write((duty * period_ + kFullDuty - 1) / kFullDuty);
    }

private:
    static constexpr const PulsePin& kPulses = Place::kPulses;
    static constexpr PulseTimer kTimer = *pulse_timer(kPulses.timer);

    static auto& timer() noexcept
    {
        if constexpr (kPulses.timer == 1) {
            return Chip::timer1();
        } else if constexpr (kPulses.timer == 3) {
            return Chip::timer3();
        } else if constexpr (kPulses.timer == 4) {
            return Chip::timer4();
        } else if constexpr (kPulses.timer == 8) {
            return Chip::timer8();
        } else if constexpr (kPulses.timer == 9) {
            return Chip::timer9();
        } else {
            return Chip::timer12();
        }
    }
    static auto& compare() noexcept
    {
        return kPulses.channel == 1   ? timer().ccr1
               : kPulses.channel == 2 ? timer().ccr2
               : kPulses.channel == 3 ? timer().ccr3
                                      : timer().ccr4;
    }

    static inline std::uint32_t hz_{0};
    static inline std::uint32_t period_{1};  // counts
};

}  // namespace cusp::hal::stm32f4
