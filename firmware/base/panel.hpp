// The words of the machine's panel: what its inputs say and what its outputs shall be.
#pragma once

#include <cstdint>

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
};

inline constexpr unsigned kInputCount = 8;
inline constexpr std::uint16_t kLimitInputs = kLimitX | kLimitY | kLimitZ;

// What the outputs other than steps shall be.
struct OutputLevels {
    bool spindle_on{false};
    bool spindle_reverse{false};
    std::uint16_t spindle_pwm{0};  // 0 to 1000 per mille
    bool flood{false};
    bool mist{false};
    bool drives_enabled{false};
    // Settings 2, 3 and 4: lines that the board inverts at the pin; frames stay logical.
    PulseLines inverted_lines{0};
    bool drives_enabled_inverted{false};

    friend constexpr bool operator==(const OutputLevels& a, const OutputLevels& b) noexcept
    {
        return a.spindle_on == b.spindle_on && a.spindle_reverse == b.spindle_reverse &&
               a.spindle_pwm == b.spindle_pwm && a.flood == b.flood && a.mist == b.mist &&
               a.drives_enabled == b.drives_enabled && a.inverted_lines == b.inverted_lines &&
               a.drives_enabled_inverted == b.drives_enabled_inverted;
    }
};

}  // namespace cusp
