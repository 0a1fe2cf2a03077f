// The words of the machine's panel: what its inputs say and what its outputs shall be.
#pragma once

#include <cstdint>

#include "firmware/base/axis.hpp"
#include "firmware/base/pulse_frame.hpp"

namespace cusp {

// Levels of the inputs, one bit each.
enum InputBit : std::uint16_t {
    kLimitX = 1U << 0U,
    kLimitY = 1U << 1U,
    kLimitZ = 1U << 2U,
    kProbe = 1U << 3U,
    kDoor = 1U << 4U,
    kHoldButton = 1U << 5U,
    kStartButton = 1U << 6U,
    kResetButton = 1U << 7U,
    kEmergencyStop = 1U << 8U,
    kMotorFault = 1U << 9U,
    // The fourth motor's switch: the second one of an axis, or that of A; read where settings 793 and 794 say so.
    kFourthLimit = 1U << 10U,
    kAtSpeed =
        1U
        << 11U,  // the spindle's drive: closed to ground at speed; read where setting 797 says so
};

inline constexpr unsigned kInputCount = 12;
inline constexpr std::uint16_t kLimitInputs = kLimitX | kLimitY | kLimitZ | kFourthLimit;
// The switch of an axis, X first; that of A is the fourth motor's.
constexpr std::uint16_t limit_input(unsigned axis) noexcept
{
    return static_cast<std::uint16_t>(axis < kLinearAxes ? unsigned{kLimitX} << axis
                                                         : unsigned{kFourthLimit});
}

// Outputs that settings 15 and 16 may invert.
enum OutputBit : std::uint8_t {
    kFloodOutput = 1U << 0U,
    kMistOutput = 1U << 1U,
    kSpindleOnOutput = 1U << 2U,
    kSpindleReverseOutput = 1U << 3U,
    kSpindlePulsesOutput = 1U << 4U,
};

// The duty cycle of the spindle's pulses that is always high.
inline constexpr std::uint16_t kFullDuty = 50000;

// The levels of all outputs but the steps.
struct OutputLevels {
    bool spindle_on{false};
    bool spindle_reverse{false};
    std::uint16_t spindle_pwm{0};      // 0 to kFullDuty
    std::uint16_t spindle_off_pwm{0};  // the same while the spindle is off
    bool follows_speed{
        false};  // a laser: the servo tick sets the duty cycle, from the machine's speed
    std::uint32_t spindle_hz{1000};  // of its pulses, at least 1
    bool flood{false};
    bool mist{false};
    std::uint8_t drives_on{0};  // motors with current: bits 0 to 3 for X, Y, Z and the second motor
    // Settings 2, 3, 4, 8, 15 and 16: what the board inverts at the pin; frames and levels stay
    // logical.
    PulseLines inverted_lines{0};
    bool drives_enable_inverted{false};
    std::uint8_t inverted_outputs{0};  // bits of OutputBit

    friend constexpr bool operator==(const OutputLevels& a, const OutputLevels& b) noexcept
    {
        return a.spindle_on == b.spindle_on && a.spindle_reverse == b.spindle_reverse &&
               a.spindle_pwm == b.spindle_pwm && a.spindle_off_pwm == b.spindle_off_pwm &&
               a.follows_speed == b.follows_speed && a.spindle_hz == b.spindle_hz &&
               a.flood == b.flood && a.mist == b.mist && a.drives_on == b.drives_on &&
               a.inverted_lines == b.inverted_lines &&
               a.drives_enable_inverted == b.drives_enable_inverted &&
               a.inverted_outputs == b.inverted_outputs;
    }
};

}  // namespace cusp
