// MillPanel: inputs, spindle, coolant and drives of a controller, on the pins that its board names.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/pulse_frame.hpp"
#include "hal/contract/board.hpp"
#include "hal/stm32f4/pins.hpp"
#include "hal/stm32f4/spindle_pulses.hpp"

namespace cusp::boards {

using hal::stm32f4::clock_bit;
using hal::stm32f4::Pin;

// Pins of a panel, each set by its name: there is no order to mistake. Inputs that stop the machine close
// to ground when at rest: a broken wire, or none, reads as tripped or pressed. Only the start button closes
// to 3.3 V when pressed. boards/mill3/pin_rules.hpp says which a board must have.
struct PanelPins {
    constexpr PanelPins() noexcept {}

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
    hal::stm32f4::PulsePin spindle_pulses;
    Pin power;  // high from the first output on: feeds drives and outputs, where a board has that
};

// In the order of InputBit.
using InputPins = std::array<Pin, 12>;
constexpr InputPins input_pins(const PanelPins& pins) noexcept
{
    return {pins.limit_x,        pins.limit_y,     pins.limit_z,      pins.probe,
            pins.door,           pins.hold,        pins.start,        pins.reset,
            pins.emergency_stop, pins.motor_fault, pins.second_limit, pins.at_speed};
}
using OutputPins = std::array<Pin, 10>;
constexpr OutputPins output_pins(const PanelPins& pins) noexcept
{
    return {pins.drives_off[0],     pins.drives_off[1],   pins.drives_off[2],
            pins.drives_off[3],     pins.flood,           pins.mist,
            pins.spindle_on,        pins.spindle_reverse, pins.power,
            pins.spindle_pulses.pin};
}

constexpr std::uint32_t clock_bits(const PanelPins& pins) noexcept
{
    std::uint32_t bits = 0;
    for (const Pin pin : input_pins(pins)) {
        bits |= clock_bit(pin);
    }
    for (const Pin pin : output_pins(pins)) {
        bits |= clock_bit(pin);
    }
    return bits;
}

// `Rules` has kPanelPins; kSpindleTimer: whether a timer makes the spindle's pulses; and where one does,
// what SpindlePulses asks of its `Place`.
template <class Chip, class Rules>
class MillPanel {
public:
    // Drives all outputs at rest before start() and set(). Uses no statics.
    static void rest(const hal::OutputLevels& off) noexcept
    {
        using namespace hal::stm32f4;
        put_levels(off);
        make_outputs();
        if constexpr (Rules::kSpindleTimer) {
            constexpr Pin kPulses = Rules::kPanelPins.spindle_pulses.pin;
            put(kPulses, false, inverts(off, kSpindlePulsesOutput));
            set_pin(port(kPulses), kPulses.number, PinMode::kOutput);
        }
    }

    // Sets the inputs' modes; leaves the outputs as they are.
    static void start() noexcept
    {
        using namespace hal::stm32f4;
        for (unsigned i = 0; i < kInputs.size(); ++i) {
            if (is_there(kInputs[i])) {
                set_pin(port(kInputs[i]), kInputs[i].number, PinMode::kInput,
                        i == kStartPlace ? Pull::kDown : Pull::kUp);
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
                bits |= level(kInputs[i]) << i;
            }
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
            hal::stm32f4::SpindlePulses<Chip, Rules>::set_duty(pwm);
        }
    }

private:
    static constexpr InputPins kInputs = input_pins(Rules::kPanelPins);
    // One line for all drives.
    static constexpr bool kOneForAll = !is_there(Rules::kPanelPins.drives_off[1]);
    static constexpr unsigned kStartPlace = 6;
    static_assert(kStartButton == 1U << kStartPlace);

    static auto& port(Pin pin) noexcept { return Chip::port(pin.port); }
    static std::uint32_t level(Pin pin) noexcept { return port(pin).idr.read() >> pin.number & 1U; }
    static void put(Pin pin, bool on, bool inverted) noexcept
    {
        hal::stm32f4::set_level(port(pin), pin.number, on != inverted);
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
            using Pulses = hal::stm32f4::SpindlePulses<Chip, Rules>;
            Pulses::set_rate(levels.spindle_hz);
            Pulses::set_duty(levels.spindle_pwm, inverts(levels, kSpindlePulsesOutput));
        }
    }
    // Levels are set before the mode, so that no output is on in between.
    static void make_outputs() noexcept
    {
        using namespace hal::stm32f4;
        constexpr OutputPins kOutputs = output_pins(Rules::kPanelPins);
        // The last is the timer's, or rest()'s.
        for (unsigned i = 0; i + 1 < kOutputs.size(); ++i) {
            if (is_there(kOutputs[i])) {
                set_pin(port(kOutputs[i]), kOutputs[i].number, PinMode::kOutput);
            }
        }
    }
    static void switch_outputs_on() noexcept
    {
        make_outputs();
        if constexpr (Rules::kSpindleTimer) {
            hal::stm32f4::SpindlePulses<Chip, Rules>::start();
        }
        outputs_on_ = true;
    }

    static inline hal::OutputLevels last_{};
    static inline bool outputs_on_{false};
};

// The order of input_pins() is that of the contract's bits.
static_assert(kLimitX == 1 && kLimitY == 2 && kLimitZ == 4 && kProbe == 8 && kDoor == 16 &&
              kHoldButton == 32 && kStartButton == 64 && kResetButton == 128 &&
              kEmergencyStop == 256 && kMotorFault == 512 && kSecondLimit == 1024 &&
              kAtSpeed == 2048);

}  // namespace cusp::boards
