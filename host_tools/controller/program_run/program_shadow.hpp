// ProgramShadow: interprets the program in parallel to the controller, with an interpreter of its own: counts moves,
// detects pauses and the end, and provides the programmed path.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <utility>

#include "firmware/gcode/interpreter.hpp"
#include "firmware/path/move.hpp"

namespace cusp::program_run {

struct ProgramMoveCounts {
    std::uint64_t rapid{0};
    std::uint64_t line{0};
    std::uint64_t arc{0};
    std::uint64_t nurbs{0};  // curves
};

// Effects of a line other than moves.
struct LineEffects {
    bool ends_program{false};
    bool pauses{false};          // M0, M1, M6
    bool changes_tool{false};    // M6
    bool ignores_rotary{false};  // A, B and C words that stand still, for the first time
    // The end position is known only after the controller's answer: a probe, a $ command.
    bool moves_by_itself{false};
};

class ProgramShadow {
public:
    // start: position at the start of the program, machine coordinates.
    // path: called with each move, and with null where the machine has moved by itself; may be empty.
    // axes: of the machine, X first.
    ProgramShadow(Position start,
                  std::function<void(const path::Move*)> path,
                  unsigned axes = kLinearAxes)
        : path_{std::move(path)}
    {
        interpreter_.set_axes(axes);
        set_position(start);
    }

    // The next line, numbered, before it is sent. A line that the interpreter refuses has no effects: the controller
    // will refuse it.
    LineEffects read(std::string_view line, std::uint64_t number);

    // The controller's position after a line that moves by itself.
    void set_position(Position at)
    {
        interpreter_.set_position(at);
        pass(nullptr);
    }

    // After a tool change that may have measured the tool: the controller's position and offsets.
    void tool_changed(Position at, const gcode::Parameters& parameters)
    {
        interpreter_.set_parameters(parameters);
        set_position(at);
    }

    // The T word in force; 0 where none was.
    int tool() const { return interpreter_.modal().tool; }

    // Inside a NURBS block.
    bool in_nurbs() const;

    const gcode::Interpreter& interpreter() const { return interpreter_; }

    const ProgramMoveCounts& moves() const { return moves_; }

private:
    void pass(const path::Move* move) const
    {
        if (path_) {
            path_(move);
        }
    }
    void take(const gcode::Action& action, LineEffects& effects);
    void count(const path::Move& move);

    gcode::Interpreter interpreter_;
    ProgramMoveCounts moves_;
    std::function<void(const path::Move*)> path_;
};

}  // namespace cusp::program_run
