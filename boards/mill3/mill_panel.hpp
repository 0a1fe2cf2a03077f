// MillPanel: inputs, spindle, coolant and drives of a controller, on the pins that its board names.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "firmware/base/pulse_frame.hpp"
#include "hal/contract/board.hpp"

namespace cusp::boards {

// Pins of a panel, each set by its name: there is no order to mistake. Inputs that stop the machine close
// to ground when at rest: a broken wire, or none, reads as tripped or pressed. Only the start button closes
// when pressed: to 3.3 V, or to ground on a chip whose pins pull up alone (Pins::kPullsDown). boards/mill3/pin_rules.hpp says which a board must have. `ChipPin` names a pin of the
// chip's family, `PulsePin` one that a timer of it makes pulses on.
template <class ChipPin, class PulsePin>
struct PanelPinsOf {
    using Pin = ChipPin;
    constexpr PanelPinsOf() noexcept {}

    Pin limit_x, limit_y, limit_z, probe;
    Pin door, hold, start, reset;
    Pin emergency_stop, motor_fault;
    Pin second_limit;  // the switch of the second motor
    Pin at_speed;      // the spindle's drive closes it to ground at speed; a board may have none
    // High: the drives are without current. One line for all of them, or one a drive; the last is the
    // second motor's.
    std::array<Pin, 4> drives_off{};
    Pin flood, mist;
    Pin spindle_on, spindle_reverse;
    PulsePin spindle_pulses;
    Pin power;  // high from the first output on: feeds drives and outputs, where a board has that
};

// In the order of InputBit.
template <class PanelPins>
using InputPins = std::array<typename PanelPins::Pin, 12>;
template <class PanelPins>
constexpr InputPins<PanelPins> input_pins(const PanelPins& pins) noexcept
{
    return {pins.limit_x,        pins.limit_y,     pins.limit_z,      pins.probe,
            pins.door,           pins.hold,        pins.start,        pins.reset,
            pins.emergency_stop, pins.motor_fault, pins.second_limit, pins.at_speed};
}
template <class PanelPins>
using OutputPins = std::array<typename PanelPins::Pin, 10>;
template <class PanelPins>
constexpr OutputPins<PanelPins> output_pins(const PanelPins& pins) noexcept
{
    return {pins.drives_off[0],     pins.drives_off[1],   pins.drives_off[2],
            pins.drives_off[3],     pins.flood,           pins.mist,
            pins.spindle_on,        pins.spindle_reverse, pins.power,
            pins.spindle_pulses.pin};
}

// `Rules` has kPanelPins; Pins: what is done with a pin of the chip (hal/stm32f4/pins.hpp, PinAccess); kSpindleTimer:
// whether a timer makes the spindle's pulses; and where one does, SpindlePulses (hal/stm32f4/spindle_pulses.hpp).
template <class Rules>
class MillPanel {
public:
    // Drives all outputs at rest before start() and set(). Uses no statics.
    static void rest(const hal::OutputLevels& off) noexcept
    {
        put_levels(off);
        make_outputs();
        if constexpr (Rules::kSpindleTimer) {
            constexpr Pin kPulses = Rules::kPanelPins.spindle_pulses.pin;
            put(kPulses, false, inverts(off, kSpindlePulsesOutput));
            Rules::Pins::make_output(kPulses);
        }
    }

    // Sets the inputs' modes; leaves the outputs as they are.
    static void start() noexcept
    {
        for (unsigned i = 0; i < kInputs.size(); ++i) {
            if (is_there(kInputs[i])) {
                Rules::Pins::make_input(kInputs[i], i == kStartPlace);
            }
        }
    }
    // Levels of rest, as the last set() inverts them. Context: any.
    static void switch_everything_off() noexcept
    {
        if (outputs_on_) {
            hal::OutputLevels off;
            off.spindle_pwm = last_.spindle_off_pwm;
            off.spindle_hz = last_.spindle_hz;
            off.inverted_outputs = last_.inverted_outputs;
            off.drives_enable_inverted = last_.drives_enable_inverted;
            apply(off);
        }
    }

    // See hal/contract/board.hpp.
    std::uint16_t inputs() const noexcept
    {
        std::uint32_t bits = 0;
        for (unsigned i = 0; i < kInputs.size(); ++i) {
            if (is_there(kInputs[i])) {
                bits |= Rules::Pins::level(kInputs[i]) << i;
            }
        }
        if constexpr (!Rules::Pins::kPullsDown) {
            bits ^= kStartButton;
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
    void set_duty(std::uint16_t pwm) noexcept
    {
        if constexpr (Rules::kSpindleTimer) {
            Rules::SpindlePulses::set_duty(pwm);
        }
    }

private:
    using PanelPins = std::decay_t<decltype(Rules::kPanelPins)>;
    using Pin = typename PanelPins::Pin;
    static constexpr InputPins<PanelPins> kInputs = input_pins(Rules::kPanelPins);
    // One line for all drives.
    static constexpr bool kOneForAll = !is_there(Rules::kPanelPins.drives_off[1]);
    static constexpr unsigned kStartPlace = 6;
    static_assert(kStartButton == 1U << kStartPlace);

    static void put(Pin pin, bool on, bool inverted) noexcept
    {
        Rules::Pins::put(pin, on != inverted);
    }
    static bool inverts(const hal::OutputLevels& levels, OutputBit bit) noexcept
    {
        return (levels.inverted_outputs & bit) != 0;
    }
    // All but the spindle's pulses.
    static void put_levels(const hal::OutputLevels& levels) noexcept
    {
        constexpr const PanelPins& kPins = Rules::kPanelPins;
        put(kPins.spindle_reverse, levels.spindle_reverse, inverts(levels, kSpindleReverseOutput));
        put(kPins.spindle_on, levels.spindle_on, inverts(levels, kSpindleOnOutput));
        put(kPins.flood, levels.flood, inverts(levels, kFloodOutput));
        put(kPins.mist, levels.mist, inverts(levels, kMistOutput));
        for (unsigned i = 0; i < kPins.drives_off.size(); ++i) {
            if (is_there(kPins.drives_off[i])) {
                const unsigned motors = kOneForAll ? levels.drives_on : levels.drives_on & 1U << i;
                put(kPins.drives_off[i], motors == 0, levels.drives_enable_inverted);
            }
        }
        if constexpr (is_there(kPins.power)) {
            put(kPins.power, true, false);
        }
    }
    static void apply(const hal::OutputLevels& levels) noexcept
    {
        put_levels(levels);
        if constexpr (Rules::kSpindleTimer) {
            using Pulses = typename Rules::SpindlePulses;
            Pulses::set_rate(levels.spindle_hz);
            Pulses::set_duty(levels.spindle_pwm, inverts(levels, kSpindlePulsesOutput));
        }
    }
    // Levels are set before the mode, so that no output is on in between.
    static void make_outputs() noexcept
    {
        constexpr OutputPins<PanelPins> kOutputs = output_pins(Rules::kPanelPins);
        // The last is the timer's, or rest()'s.
        for (unsigned i = 0; i + 1 < kOutputs.size(); ++i) {
            if (is_there(kOutputs[i])) {
                Rules::Pins::make_output(kOutputs[i]);
            }
        }
    }
    static void switch_outputs_on() noexcept
    {
        make_outputs();
        if constexpr (Rules::kSpindleTimer) {
            Rules::SpindlePulses::start();
        }
        outputs_on_ = true;
    }

    static inline hal::OutputLevels last_{};
    static inline bool outputs_on_{false};
};

// The order of input_pins() is that of the contract's bits.
static_assert(kLimitX == 1 && kLimitY == 2 && kLimitZ == 4 && kProbe == 8 && kDoor == 16 &&
              kHoldButton == 32 && kStartButton == 64 && kResetButton == 128 &&
              kEmergencyStop == 256 && kMotorFault == 512 && kFourthLimit == 1024 &&
              kAtSpeed == 2048);

}  // namespace cusp::boards
