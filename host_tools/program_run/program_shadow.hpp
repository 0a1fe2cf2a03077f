// ProgramShadow: what the program asks for, read by an interpreter of our own beside the
// controller's: counts moves, sees the end and the pauses, and knows the path.
#pragma once

#include <cstdint>
#include <string_view>

#include "firmware/gcode/interpreter.hpp"
#include "host_tools/program_run/path_deviation.hpp"

namespace cusp::program_run {

struct ProgramMoveCounts {
    std::uint64_t rapid{0};
    std::uint64_t line{0};
    std::uint64_t arc{0};
    std::uint64_t nurbs{0};  // curves
};

// What a line asks for beyond moves.
struct LineEffects {
    bool ends_program{false};
    bool pauses{false};        // M0, M1, M6
    bool changes_tool{false};  // M6
    // The position is known once the controller has answered: a probe, a $ command.
    bool moves_by_itself{false};
};

class ProgramShadow {
public:
    // The program starts here, machine coordinates.
    explicit ProgramShadow(Position start) { set_position(start); }

    // The next line, numbered, before it is sent. A line that the interpreter refuses has no
    // effects: the controller will say so.
    LineEffects read(std::string_view line, std::uint64_t number);

    // Where the controller stands after a line that moves by itself.
    void set_position(Position at)
    {
        interpreter_.set_position(at);
        deviation_.restart();
    }

    // After a tool change that may have measured the tool: where the controller stands, and its offsets.
    void tool_changed(Position at, const gcode::Parameters& parameters)
    {
        interpreter_.set_parameters(parameters);
        set_position(at);
    }

    // The T word in force; 0 where none was.
    int tool() const { return interpreter_.modal().tool; }

    // A NURBS is begun and not ended.
    bool in_nurbs() const;

    const ProgramMoveCounts& moves() const { return moves_; }
    PathDeviation& deviation() { return deviation_; }
    const PathDeviation& deviation() const { return deviation_; }

private:
    void take(const gcode::Action& action, LineEffects& effects);
    void count(const path::Move& move);

    gcode::Interpreter interpreter_;
    ProgramMoveCounts moves_;
    PathDeviation deviation_;
};

}  // namespace cusp::program_run
