// Converts text to moves: reads one line of G-code, checks it against the modal state, and yields
// its actions one by one. docs/gcode.md lists the dialect.
//
//   Interpreter interpreter;
//   Status status = interpreter.execute(line, number);   // reads and checks; starts nothing
//   Action action;
//   while (interpreter.next(action)) { ... }             // when there is room for a move
//
// A line is refused as a whole: after an error nothing has changed, neither modal state nor
// position, and next() yields nothing. One exception: an error inside a NURBS (G5.2, G6.2) gives up
// the rest of that curve, so that no later line can be taken for a part of it; pieces already
// yielded stay, and the position is where they end.
#pragma once

#include <cstdint>
#include <string_view>

#include "firmware/base/result.hpp"
#include "firmware/gcode/action.hpp"
#include "firmware/gcode/line_context.hpp"
#include "firmware/gcode/modal_state.hpp"
#include "firmware/gcode/motion_plan.hpp"
#include "firmware/nurbs/piece_stream.hpp"

namespace cusp::gcode {

// The rule for lines with M6; the machine sets it.
enum class ToolChangeRule : std::uint8_t {
    kFree,      // anything
    kTouchOff,  // T 1 to 16, and nothing in the line that depends on the length of the new tool
    kNotHomed,  // refused: axes that it needs are not homed
    kNoPlace,   // refused: the place of the change was never set
};

class Interpreter {
public:
    // Reads one line without its line end: comments, spaces, lower case and '/' are understood.
    // Nothing moves yet: the actions are fetched with next().
    //
    //   number  for reports, where the line has no N word.
    //
    // Errors: 1, 2, 4, 20 to 38, 46 and 47 of error.hpp; docs/gcode.md says which for what.
    // Precondition: the actions of the line before have all been fetched, or discard() was called.
    Status execute(std::string_view text, std::uint32_t number) noexcept;

    // Reads the words after `$J=`: G20 G21 G53 G90 G91, axis words, F and N. Yields one Move of
    // kind kFixedFeed and leaves the modal state alone.
    //
    // Errors: kInvalidJogCommand for another command; otherwise as execute().
    Status execute_jog(std::string_view text, std::uint32_t number) noexcept;

    // The next action of the line: false, and nothing written, where there is none left.
    // Cost: bounded; a NURBS piece costs most.
    bool next(Action& action) noexcept;

    // Forgets the actions that were not fetched. The position is then unknown to the interpreter
    // until set_position().
    void discard() noexcept;

    // Sets the position of the machine: after a probe, homing, a jog that was cancelled, a reset.
    // Precondition: no action is left to fetch. An open NURBS is given up.
    void set_position(Position machine) noexcept;

    // The position once all fetched actions are done; machine coordinates.
    Position position() const noexcept { return position_.rounded(); }

    // As at power-up: modal state at its defaults, G92 and the tool length offset cleared, an open
    // NURBS and unfetched actions forgotten. Position, stored parameters and the tool in the spindle
    // stay.
    void reset() noexcept;

    // The path tolerance of $11, mm, in force at power-up, after M2 and M30 and with G64 alone.
    void set_default_tolerance(float mm) noexcept { default_tolerance_ = mm; }

    // Axes of the machine, X first: 4 with A.
    void set_axes(unsigned count) noexcept { axes_ = count; }

    // The operator or an alarm has switched them.
    void set_coolant(bool flood, bool mist) noexcept;
    void set_spindle_off() noexcept { modal_.spindle = SpindleMode::kOff; }

    // Holds until the next call.
    void set_tool_change_rule(ToolChangeRule rule) noexcept { tool_change_rule_ = rule; }

    // Sets the length that the touch-off of an M6 has measured for the tool of the T word, in the
    // tool table and in the offset in force. The machine has moved, so that the position in program
    // coordinates is the same as before.
    // Precondition: the line was read with kTouchOff; fits_tool_table(length_nm).
    void take_tool_length(std::int64_t length_nm) noexcept;

    // The path tolerance now in force, mm; 0 with G61.
    float path_tolerance() const noexcept;

    const ModalState& modal() const noexcept { return modal_; }
    const Parameters& parameters() const noexcept { return parameters_; }

    // Sets offsets from the store, or after `$RST=#`. Precondition: no action is left to fetch.
    void set_parameters(const Parameters& parameters) noexcept { parameters_ = parameters; }

private:
    LineContext begin(std::uint32_t number) const noexcept;
    Status run(LineContext& line) noexcept;
    Status check(LineContext& line) noexcept;
    Status check_tool_change(const LineContext& line) const noexcept;
    void remember_cycle(LineContext& line) noexcept;
    void commit_rotary(const Command& command) noexcept;
    Status run_jog(LineContext& line) noexcept;
    void commit(const LineContext& line) noexcept;
    void end_program() noexcept;

    bool in_curve() const noexcept;
    Status check_new_curve(LineContext& line) noexcept;
    void open_curve(const LineContext& line) noexcept;
    Status continue_curve(LineContext& line) noexcept;
    Status continue_uniform(LineContext& line) noexcept;
    Status continue_knotted(LineContext& line) noexcept;
    void plan_pieces(const LineContext& line) noexcept;
    void give_up_curve() noexcept;

    ModalState modal_;
    Parameters parameters_;
    ExactPosition position_;
    DrillMemory drill_;
    DrillMemory drill_after_;  // the line, where it is of a cycle
    RotaryAxes rotary_;
    RotaryAxes rotary_after_;  // the line, where it has words of them
    float default_tolerance_{0.010F};
    unsigned axes_{kLinearAxes};
    ToolChangeRule tool_change_rule_{ToolChangeRule::kFree};
    MotionPlan plan_;
    nurbs::PieceStream curve_;
};

}  // namespace cusp::gcode
