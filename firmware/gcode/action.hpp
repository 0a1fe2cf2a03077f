// The actions that one line requests. The machine performs them in order.
#pragma once

#include <cstdint>
#include <variant>

#include "firmware/gcode/modal_state.hpp"
#include "firmware/path/move.hpp"

namespace cusp::gcode {

// Moves to `move.end` until the probe answers. Tell the interpreter where it ended: set_position().
struct Probe {
    path::Move move;  // a line
    bool away;        // G38.4 and G38.5: until contact is lost
    bool alarm;       // G38.2 and G38.4: an alarm where the end is reached first
};

// A wait that begins when all motion before it is finished.
struct Dwell {
    double seconds;  // >= 0
};

struct Spindle {
    SpindleMode mode;
    float speed;  // rpm
};

// Offsets or stored positions have changed: `Interpreter::parameters()` holds the new ones.
struct ParametersChanged {
    bool keep;          // through a power cycle: all but G52, G92, G92.1, G43, G43.1 and G49
    std::uint8_t tool;  // with a new length, by G10 L1, L10 and L11; 0: none
};

// M0 and M1: once all motion before it is finished, wait for the cycle start.
struct Pause {
    bool optional;  // M1
};

// M6: once all motion before it is finished; a setting of the machine chooses what is done.
struct ToolChange {
    std::uint8_t tool;
    std::uint32_t line;  // for reports
};

// A, B and C words that move nothing were ignored; once in a program.
struct RotaryIgnored {};

// M2 and M30. The modal state is already back at its defaults; spindle and coolant stop.
struct ProgramEnd {};

using Action = std::variant<path::Move,
                            Probe,
                            Dwell,
                            Spindle,
                            Coolant,
                            ParametersChanged,
                            Pause,
                            ToolChange,
                            RotaryIgnored,
                            ProgramEnd>;

}  // namespace cusp::gcode
