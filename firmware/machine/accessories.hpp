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

// Servo ticks until the spindle is up once it was switched on: $394.
std::uint32_t spindle_ticks(const Settings& settings) noexcept;

// Servo ticks until all that is on is up, once a door or the operator has stopped it: as long as Grbl
// waits, 4 s for the spindle and 1 s for coolant. $394 replaces that where it is not 0.
std::uint32_t restoring_ticks(const Accessories& accessories, const Settings& settings) noexcept;

// Speed of the spindle, rpm: the programmed speed with the override, inside $31 to $30. 0 when
// it is off.
float spindle_speed(const Accessories& accessories,
                    unsigned override_percent,
                    const Settings& settings) noexcept;

OutputLevels output_levels(const Accessories& accessories,
                           unsigned spindle_override_percent,
                           bool drives_enabled,
                           const Settings& settings) noexcept;

}  // namespace cusp::machine
