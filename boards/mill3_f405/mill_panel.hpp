// MillPanel: the pins of the mill controller, other than the serial line's.
// boards/mill3_f405/README.md has them as a wiring table.
#pragma once

#include <cstdint>

#include "hal/contract/board.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/pins.hpp"

namespace cusp::boards {

// The six step and direction lines: pins 0 to 5 of port C, so that one word moves any of them.
template <class Chip>
struct StepPort {
    static constexpr PulseLines kInvertedLines = 0;
    static auto& gpio() noexcept { return Chip::port_c(); }
};

// `Rules::kSpindleTimer` says whether timer 3 makes the spindle's pulses.
template <class Chip, class Rules>
class MillPanel {
public:
    static void start() noexcept
    {
        using namespace hal::stm32f4;
        for (unsigned pin = 0; pin < 6; ++pin) {
            set_pin(Chip::port_c(), pin, PinMode::kOutput);
        }
        set_level(Chip::port_c(), kDrivesOff, true);
        set_pin(Chip::port_c(), kDrivesOff, PinMode::kOutput);
        set_pin(Chip::port_c(), kFlood, PinMode::kOutput);
        set_pin(Chip::port_c(), kMist, PinMode::kOutput);
        set_pin(Chip::port_a(), kSpindleOn, PinMode::kOutput);
        set_pin(Chip::port_a(), kSpindleReverse, PinMode::kOutput);
        // Limits and probe: a closed contact to ground is at rest, a broken wire reads as tripped.
        for (unsigned pin = kFirstSwitch; pin < kFirstSwitch + 4; ++pin) {
            set_pin(Chip::port_b(), pin, PinMode::kInput, Pull::kUp);
        }
        // Buttons: a contact to 3.3 V; nothing wired reads as not pressed.
        for (unsigned pin = kFirstButton; pin < kFirstButton + 4; ++pin) {
            set_pin(Chip::port_b(), pin, PinMode::kInput, Pull::kDown);
        }
        if constexpr (Rules::kSpindleTimer) {
            start_spindle_timer();
        }
    }

    // See hal/contract/board.hpp.
    std::uint16_t inputs() const noexcept
    {
        const std::uint32_t pins = Chip::port_b().idr.read();
        return static_cast<std::uint16_t>((pins >> kFirstSwitch & 0xFU) |
                                          (pins >> kFirstButton & 0xFU) << 4U);
    }
    void set(const hal::OutputLevels& levels) noexcept
    {
        using hal::stm32f4::set_level;
        set_level(Chip::port_a(), kSpindleReverse, levels.spindle_reverse);
        set_level(Chip::port_a(), kSpindleOn, levels.spindle_on);
        set_level(Chip::port_c(), kFlood, levels.flood);
        set_level(Chip::port_c(), kMist, levels.mist);
        set_level(Chip::port_c(), kDrivesOff, !levels.drives_enabled);
        if constexpr (Rules::kSpindleTimer) {
            Chip::timer3().ccr1.write(levels.spindle_on ? levels.spindle_pwm : 0U);
        }
    }

private:
    // Port C.
    static constexpr unsigned kDrivesOff = 6;
    static constexpr unsigned kFlood = 7;
    static constexpr unsigned kMist = 8;
    // Port A.
    static constexpr unsigned kSpindleOn = 5;
    static constexpr unsigned kSpindlePulses = 6;
    static constexpr unsigned kSpindleReverse = 7;
    // Port B: limits X Y Z and probe; door, hold, start, reset.
    static constexpr unsigned kFirstSwitch = 12;
    static constexpr unsigned kFirstButton = 6;

    // 1 kHz, a step of the duty cycle a per mille.
    static void start_spindle_timer() noexcept
    {
        constexpr std::uint32_t kTimer3OnPin = 2;
        constexpr std::uint32_t kPulseMode = 6U << 4U | 1U << 3U;
        auto& timer = Chip::timer3();
        hal::stm32f4::set_pin_function(Chip::port_a(), kSpindlePulses, kTimer3OnPin);
        timer.psc.write(hal::stm32f4::kSlowTimerHz / 1000000 - 1);
        timer.arr.write(999);
        timer.ccmr1.write(kPulseMode);
        timer.ccr1.write(0);
        timer.ccer.write(1);
        timer.egr.write(1);
        timer.cr1.write(1U << 7U | 1U);
    }
};

// Bits of the two groups of four pins are the contract's.
static_assert(hal::kLimitX == 1 && hal::kProbe == 8 && hal::kDoor == 16 &&
              hal::kResetButton == 128);

}  // namespace cusp::boards
