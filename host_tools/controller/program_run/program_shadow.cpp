// Interprets lines in parallel to the controller.
#include "host_tools/controller/program_run/program_shadow.hpp"

namespace cusp::program_run {

LineEffects ProgramShadow::read(std::string_view line, std::uint64_t number)
{
    LineEffects effects;
    if (!line.empty() && line.front() == '$') {
        effects.moves_by_itself = true;
        return effects;
    }
    const bool was_in_nurbs = in_nurbs();
    if (!interpreter_.execute(line, static_cast<std::uint32_t>(number))) {
        return effects;
    }
    if (in_nurbs() && !was_in_nurbs) {
        ++moves_.nurbs;
    }
    gcode::Action action;
    while (interpreter_.next(action)) {
        take(action, effects);
    }
    return effects;
}

bool ProgramShadow::in_nurbs() const
{
    const gcode::Motion motion = interpreter_.modal().motion;
    return motion == gcode::Motion::kUniformNurbs || motion == gcode::Motion::kNurbs;
}

void ProgramShadow::take(const gcode::Action& action, LineEffects& effects)
{
    if (const auto* move = std::get_if<path::Move>(&action)) {
        count(*move);
        pass(move);
    } else if (const auto* probe = std::get_if<gcode::Probe>(&action)) {
        count(probe->move);
        pass(&probe->move);
        effects.moves_by_itself = true;
    }
    effects.ignores_rotary =
        effects.ignores_rotary || std::holds_alternative<gcode::RotaryIgnored>(action);
    effects.ends_program =
        effects.ends_program || std::holds_alternative<gcode::ProgramEnd>(action);
    effects.changes_tool =
        effects.changes_tool || std::holds_alternative<gcode::ToolChange>(action);
    effects.pauses =
        effects.pauses || effects.changes_tool || std::holds_alternative<gcode::Pause>(action);
}

void ProgramShadow::count(const path::Move& move)
{
    if (std::holds_alternative<path::BezierPiece>(move.path)) {
        return;  // a curve is counted at its first piece
    }
    if (std::holds_alternative<path::Arc>(move.path)) {
        ++moves_.arc;
    } else if (move.start != move.end) {
        ++(move.kind == path::MoveKind::kRapid ? moves_.rapid : moves_.line);
    }
}

}  // namespace cusp::program_run
