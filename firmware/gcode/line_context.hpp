// One line during the checks: its words, and the modal state after it.
// Nothing here is the interpreter's own state, so a refused line leaves no trace.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/axis.hpp"
#include "firmware/gcode/command.hpp"
#include "firmware/gcode/motion_plan.hpp"

namespace cusp::gcode {

// The words of a cycle hold until another motion command; the initial level until one that is no
// cycle.
struct DrillMemory {
    LetterSet known{0};
    std::uint8_t level_axis{
        kAxisCount};        // the axis of the initial level; kAxisCount: there is none
    ExactLength level;      // before the first cycle of the series; in program coordinates
    ExactLength clearance;  // R, as written
    ExactLength bottom;     // depth of the hole, as written
    ExactLength peck;       // Q
    double dwell_seconds{0};
};

// Axes of A B C that the machine lacks: their words may not move one. Before its first word, and before the
// first feed move, an axis may be anywhere.
struct RotaryAxes {
    std::array<Decimal, 3> at{};
    LetterSet known{0};
    bool noted{false};  // that words are ignored, in this program
};

struct LineContext {
    Command command;
    Parameters parameters;
    DrillMemory* drill{nullptr};  // after the line, of a cycle
    ExactPosition start;          // of the line
    ExactPosition end;
    float default_tolerance{0};
    std::uint32_t number{0};
};

// The path tolerance in force, mm.
float path_tolerance(const ModalState& modal, float default_tolerance) noexcept;

// A length word, in the units of the line. A's are degrees.
inline Result<ExactLength> length_of(const Command& command, char upper_case) noexcept
{
    return to_length(command.value(upper_case), command.modal.inches && upper_case != 'A');
}

// Checks the F word, and whether the motion of the line needs one. Errors: kGcodeUndefinedFeedRate,
// kGcodeMaxValueExceeded.
Status check_feed(LineContext& line, bool was_inverse_time) noexcept;

// Sets `line.end` from the axis words. Errors: kGcodeMaxValueExceeded.
Status find_target(LineContext& line) noexcept;

// A move with the feed and tolerance in force and the number of the line; path and ends are still
// to be set.
path::Move move_pattern(const ModalState& modal,
                        const LineContext& line,
                        path::MoveKind kind) noexcept;

// Sets the speed of a feed move whose path and ends are set, after G93 or G94.
void set_speed(const ModalState& modal, path::Move& move) noexcept;

// Adds a straight move to line.end to the plan, unless it has no length.
void plan_line(const LineContext& line, path::MoveKind kind, MotionPlan& plan) noexcept;

// Checks that the A, B and C words of a line stand still, and uses them. `rotary` is the state before the
// line, and after it. Errors: kGcodeUnsupportedCommand.
Status check_rotary(Command& command, RotaryAxes& rotary, MotionPlan& plan) noexcept;

// Plans G10, G28.1, G30.1, G52, G92, G92.1, G43, G43.1 and G49. Errors: 20, 23, 26, 28, 29, 37, 38.
Status plan_offsets(LineContext& line, MotionPlan& plan) noexcept;

// Plans G28, G30 and the motion commands except NURBS. Errors: 22, 26, 28 and 30 to 38.
Status plan_motion(LineContext& line, MotionPlan& plan) noexcept;

// Plans cycles. Errors: kGcodeNoAxisWords, kGcodeValueWordMissing, kGcodeInvalidTarget,
// kGcodeMaxValueExceeded.
Status plan_drilling(LineContext& line, MotionPlan& plan) noexcept;

}  // namespace cusp::gcode
