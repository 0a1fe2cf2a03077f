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

// Pins of a panel. What stops the machine closes to ground when at rest: a broken wire, or none,
// reads as tripped or pressed. Only the start button closes to 3.3 V when pressed.
struct PanelPins {
    std::array<Pin, 4> switches;    // limits X Y Z, probe
    std::array<Pin, 4> buttons;     // door, hold, start, reset
    std::array<Pin, 2> protectors;  // emergency stop, motor fault
    Pin drives_off;                 // high: the drives are without current
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
    // Sets the inputs' modes. Outputs stay inputs, as the reset left them, until set() knows which
    // level is off.
    static void start() noexcept
    {
        using namespace hal::stm32f4;
        constexpr const PanelPins& kPins = Rules::kPanelPins;
        for (const Pin pin : kPins.switches) {
            set_pin(port(pin), pin.number, PinMode::kInput, Pull::kUp);
        }
        for (unsigned i = 0; i < kPins.buttons.size(); ++i) {
            const Pull pull = i == kStartPlace ? Pull::kDown : Pull::kUp;
            set_pin(port(kPins.buttons[i]), kPins.buttons[i].number, PinMode::kInput, pull);
        }
        for (const Pin pin : kPins.protectors) {
            set_pin(port(pin), pin.number, PinMode::kInput, Pull::kUp);
        }
    }
    // Levels of rest, as the last set() inverts them. Context: any.
    static void switch_everything_off() noexcept
    {
        if (outputs_on_) {
            hal::OutputLevels off;
            off.inverted_outputs = last_.inverted_outputs;
            off.drives_enabled_inverted = last_.drives_enabled_inverted;
            apply(off);
        }
    }

    // See hal/contract/board.hpp.
    std::uint16_t inputs() const noexcept
    {
        constexpr const PanelPins& kPins = Rules::kPanelPins;
        std::uint32_t bits = 0;
        for (unsigned i = 0; i < 4; ++i) {
            bits |= level(kPins.switches[i]) << i;
            bits |= level(kPins.buttons[i]) << (i + 4);
        }
        for (unsigned i = 0; i < 2; ++i) {
            bits |= level(kPins.protectors[i]) << (i + 8);
        }
        return static_cast<std::uint16_t>(bits);
    }
    void set(const hal::OutputLevels& levels) noexcept
    {
        last_ = levels;
        apply(levels);
        if (!outputs_on_) {
            switch_outputs_on();
        }
    }

private:
    static constexpr unsigned kStartPlace = 2;

    static constexpr auto& port(Pin pin) noexcept
    {
        return pin.port == 'A' ? Chip::port_a() : pin.port == 'B' ? Chip::port_b() : Chip::port_c();
    }
    static std::uint32_t level(Pin pin) noexcept { return port(pin).idr.read() >> pin.number & 1U; }
    static void put(Pin pin, bool on, bool inverted) noexcept
    {
        hal::stm32f4::set_level(port(pin), pin.number, on != inverted);
    }
    static void apply(const hal::OutputLevels& levels) noexcept
    {
        constexpr const PanelPins& kPins = Rules::kPanelPins;
        const auto inverted = [&levels](OutputBit bit) {
            return (levels.inverted_outputs & bit) != 0;
        };
        put(kPins.spindle_reverse, levels.spindle_reverse, inverted(kSpindleReverseOutput));
        put(kPins.spindle_on, levels.spindle_on, inverted(kSpindleOnOutput));
        put(kPins.flood, levels.flood, inverted(kFloodOutput));
        put(kPins.mist, levels.mist, inverted(kMistOutput));
        put(kPins.drives_off, !levels.drives_enabled, levels.drives_enabled_inverted);
        if constexpr (Rules::kSpindleTimer) {
            // The polarity of the timer's output; 0 of the compare is off.
            Chip::timer3().ccer.write(inverted(kSpindlePulsesOutput) ? 3U : 1U);
            Chip::timer3().ccr1.write(levels.spindle_on ? levels.spindle_pwm : 0U);
        }
    }
    // The levels are there first: nothing starts by itself.
    static void switch_outputs_on() noexcept
    {
        using namespace hal::stm32f4;
        constexpr const PanelPins& kPins = Rules::kPanelPins;
        for (const Pin pin :
             {kPins.drives_off, kPins.flood, kPins.mist, kPins.spindle_on, kPins.spindle_reverse}) {
            set_pin(port(pin), pin.number, PinMode::kOutput);
        }
        if constexpr (Rules::kSpindleTimer) {
            start_spindle_timer();
        }
        outputs_on_ = true;
    }

    // 1 kHz, a step of the duty cycle a per mille.
    static void start_spindle_timer() noexcept
    {
        constexpr std::uint32_t kTimer3OnPin = 2;
        constexpr std::uint32_t kPulseMode = 6U << 4U | 1U << 3U;
        constexpr Pin kPin = Rules::kPanelPins.spindle_pulses;
        auto& timer = Chip::timer3();
        timer.psc.write(Rules::kSpindleTimerHz / 1000000 - 1);
        timer.arr.write(999);
        timer.ccmr1.write(kPulseMode);
        timer.egr.write(1);
        timer.cr1.write(1U << 7U | 1U);
        hal::stm32f4::set_pin_function(port(kPin), kPin.number, kTimer3OnPin);
    }

    static inline hal::OutputLevels last_{};
    static inline bool outputs_on_{false};
};

// The order of PanelPins is that of the contract's bits.
static_assert(kLimitX == 1 && kLimitY == 2 && kLimitZ == 4 && kProbe == 8 && kDoor == 16 &&
              kHoldButton == 32 && kStartButton == 64 && kResetButton == 128 &&
              kEmergencyStop == 256 && kMotorFault == 512);

}  // namespace cusp::boards
