// The remaining work of one line: flags and the source of its moves.
#pragma once

#include <cstdint>
#include <variant>

#include "firmware/gcode/action.hpp"
#include "firmware/gcode/drill_cycle.hpp"
#include "firmware/nurbs/piece_stream.hpp"

namespace cusp::gcode {

// One move, then perhaps a rapid on to another place (G28 and G30 through a point).
struct Moves {
    path::Move first;
    Position then;
    bool first_left;
    bool then_left;
};

// Pieces of the open NURBS: `pattern` holds their feed, tolerance and line.
struct CurveMoves {
    path::Move pattern;
};

using MotionSource = std::variant<std::monostate, Moves, Probe, DrillCycle, CurveMoves>;

// The order of actions within a line, as in Grbl 1.1 and NIST RS274/NGC section 3.8.
class MotionPlan {
public:
    enum class Step : std::uint8_t {
        kRotaryIgnored,
        kToolChange,
        kSpindle,
        kCoolant,
        kDwell,
        kParameters,
        kMotion,
        kFlow,
        kEnd
    };

    void add(Step step) noexcept { steps_ |= 1U << static_cast<unsigned>(step); }
    bool has(Step step) const noexcept { return (steps_ & 1U << static_cast<unsigned>(step)) != 0; }
    void clear() noexcept { steps_ = 0; }
    bool empty() const noexcept { return steps_ == 0; }

    // The next action; `curve` yields the pieces of CurveMoves. The fields below hold the remaining work.
    bool next(nurbs::PieceStream& curve, Action& action) noexcept;

    ToolChange tool_change{};
    Spindle spindle{};
    Coolant coolant{};
    Dwell dwell{};
    ParametersChanged parameters{};
    MotionSource motion;
    std::variant<Pause, ProgramEnd> flow;

private:
    bool next_motion(nurbs::PieceStream& curve, Action& action) noexcept;

    std::uint32_t steps_{0};
};

}  // namespace cusp::gcode
