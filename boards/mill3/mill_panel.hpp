// MillPanel: inputs, spindle, coolant and drives of a controller, on the pins that its board names.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/pulse_frame.hpp"
#include "hal/contract/board.hpp"
#include "hal/stm32f4/pins.hpp"

namespace cusp::boards {

struct Pin {
    char port;  // 'A' to 'C'
    unsigned number;
};

// Pins of a panel. Switches close to ground when at rest (a broken wire reads as tripped); buttons
// close to 3.3 V when pressed (nothing wired reads as not pressed).
struct PanelPins {
    std::array<Pin, 4> switches;  // limits X Y Z, probe
    std::array<Pin, 4> buttons;   // door, hold, start, reset
    Pin drives_off;               // high: the drives are without current
    Pin flood;
    Pin mist;
    Pin spindle_on;
    Pin spindle_reverse;
    Pin spindle_pulses;  // channel 1 of timer 3, alternate function 2
};

// `Rules` has kPanelPins; kSpindleTimer: whether timer 3 makes the spindle's pulses; and
// kSpindleTimerHz: what timer 3 counts.
template <class Chip, class Rules>
class MillPanel {
public:
    // Sets the pins' modes, levels first: nothing starts by itself.
    static void start() noexcept
    {
        using namespace hal::stm32f4;
        constexpr const PanelPins& kPins = Rules::kPanelPins;
        switch_everything_off();
        for (const Pin pin :
             {kPins.drives_off, kPins.flood, kPins.mist, kPins.spindle_on, kPins.spindle_reverse}) {
            set_pin(port(pin), pin.number, PinMode::kOutput);
        }
        for (const Pin pin : kPins.switches) {
            set_pin(port(pin), pin.number, PinMode::kInput, Pull::kUp);
        }
        for (const Pin pin : kPins.buttons) {
            set_pin(port(pin), pin.number, PinMode::kInput, Pull::kDown);
        }
        for (unsigned pin = 0; pin < 6; ++pin) {
            set_pin(Rules::StepPort::gpio(), pin, PinMode::kOutput);
        }
        if constexpr (Rules::kSpindleTimer) {
            start_spindle_timer();
        }
    }
    static void switch_everything_off() noexcept { apply({}); }

    // See hal/contract/board.hpp.
    std::uint16_t inputs() const noexcept
    {
        constexpr const PanelPins& kPins = Rules::kPanelPins;
        std::uint32_t bits = 0;
        for (unsigned i = 0; i < 4; ++i) {
            bits |= level(kPins.switches[i]) << i;
            bits |= level(kPins.buttons[i]) << (i + 4);
        }
        return static_cast<std::uint16_t>(bits);
    }
    void set(const hal::OutputLevels& levels) noexcept { apply(levels); }

private:
    static constexpr auto& port(Pin pin) noexcept
    {
        return pin.port == 'A' ? Chip::port_a() : pin.port == 'B' ? Chip::port_b() : Chip::port_c();
    }
    static std::uint32_t level(Pin pin) noexcept { return port(pin).idr.read() >> pin.number & 1U; }
    static void put(Pin pin, bool high) noexcept
    {
        hal::stm32f4::set_level(port(pin), pin.number, high);
    }
    static void apply(const hal::OutputLevels& levels) noexcept
    {
        constexpr const PanelPins& kPins = Rules::kPanelPins;
        put(kPins.spindle_reverse, levels.spindle_reverse);
        put(kPins.spindle_on, levels.spindle_on);
        put(kPins.flood, levels.flood);
        put(kPins.mist, levels.mist);
        put(kPins.drives_off, !levels.drives_enabled);
        if constexpr (Rules::kSpindleTimer) {
            Chip::timer3().ccr1.write(levels.spindle_on ? levels.spindle_pwm : 0U);
        }
    }

    // 1 kHz, a step of the duty cycle a per mille.
    static void start_spindle_timer() noexcept
    {
        constexpr std::uint32_t kTimer3OnPin = 2;
        constexpr std::uint32_t kPulseMode = 6U << 4U | 1U << 3U;
        constexpr Pin kPin = Rules::kPanelPins.spindle_pulses;
        auto& timer = Chip::timer3();
        hal::stm32f4::set_pin_function(port(kPin), kPin.number, kTimer3OnPin);
        timer.psc.write(Rules::kSpindleTimerHz / 1000000 - 1);
        timer.arr.write(999);
        timer.ccmr1.write(kPulseMode);
        timer.ccr1.write(0);
        timer.ccer.write(1);
        timer.egr.write(1);
        timer.cr1.write(1U << 7U | 1U);
    }
};

// The order of PanelPins is that of the contract's bits.
static_assert(kLimitX == 1 && kLimitY == 2 && kLimitZ == 4 && kProbe == 8 && kDoor == 16 &&
              kHoldButton == 32 && kStartButton == 64 && kResetButton == 128);

}  // namespace cusp::boards
