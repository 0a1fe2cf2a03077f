// Accessories: outputs of spindle, coolant and drives, from program, operator and safety.
#pragma once

#include <cstdint>

#include "firmware/base/panel.hpp"
#include "firmware/gcode/modal_state.hpp"
#include "firmware/machine/settings.hpp"

namespace cusp::machine {

struct Accessories {
    gcode::SpindleMode spindle{gcode::SpindleMode::kOff};
    float speed{0};  // rpm, as programmed
    bool flood{false};
    bool mist{false};
    // Off for a while, though the program wants them: in a hold (0x9E), at an open door.
    bool spindle_paused{false};
    bool coolant_paused{false};
    bool changing_tool{false};  // both off, even if the operator switches them on

    bool spindle_on() const noexcept
    {
        return spindle != gcode::SpindleMode::kOff && !spindle_paused && !changing_tool;
    }
    bool flood_on() const noexcept { return flood && !coolant_paused && !changing_tool; }
    bool mist_on() const noexcept { return mist && !coolant_paused && !changing_tool; }

    // True if the spindle, off or slower before, has to come up to speed now: it was switched on, given
    // a speed or turned about.
    bool spindle_starts_after(const Accessories& before) const noexcept;
};

// The duty cycle of the spindle's pulses by its speed: $34 while it is off, $35 at $31 and below, $36 at
// $30 and above, a line between them. While it is on the duty is never 0.
class DutyLaw {
public:
    explicit DutyLaw(const Settings& settings) noexcept;

    // 0 to kFullDuty. speed: rpm; 0: off.
    std::uint16_t duty(float speed) const noexcept
    {
        if (speed <= 0) {
            return off_;
        }
        const float wanted = base_ + (speed - least_speed_) * rise_;
        const float limited = wanted < least_ ? least_ : wanted > most_ ? most_ : wanted;
        return static_cast<std::uint16_t>(limited + 0.5F);
    }

private:
    std::uint16_t off_;
    float least_speed_;  // rpm
    float least_;        // while it is on
    float most_;
    float base_{0};  // at the least speed
    float rise_{0};  // with each rpm
};

// Servo ticks until the spindle is up once it was switched on: $394.
std::uint32_t spindle_ticks(const Settings& settings) noexcept;

// Servo ticks until all that is on is up, once a door or the operator has stopped it: as long as Grbl
// waits, 4 s for the spindle and 1 s for coolant. $394 replaces that where it is not 0. A laser is up
// at once.
std::uint32_t restoring_ticks(const Accessories& accessories, const Settings& settings) noexcept;

// Speed of the spindle, rpm: the programmed speed with the override, inside $31 to $30. 0 when
// it is off.
float spindle_speed(const Accessories& accessories,
                    unsigned override_percent,
                    const Settings& settings) noexcept;

// `drives`: axes whose motors have current.
OutputLevels output_levels(const Accessories& accessories,
                           unsigned spindle_override_percent,
                           AxisMask drives,
                           const Settings& settings) noexcept;

}  // namespace cusp::machine
