// What each action of G-code does to the machine.
#include "firmware/machine/program_actions.hpp"

#include "firmware/machine/travel.hpp"

namespace cusp::machine {

Status ProgramActions::read(std::string_view line) noexcept
{
    jogs_ = false;
    core_.interpreter.set_tool_change_rule(tool_change_.rule());
    return core_.interpreter.execute(line, core_.lines.line_number());
}

Status ProgramActions::read_jog(std::string_view words) noexcept
{
    const Status status = core_.interpreter.execute_jog(words, core_.lines.line_number());
    jogs_ = true;
    return status;
}

void ProgramActions::drop() noexcept
{
    action_waits_ = false;
    phase_ = Phase::kNext;
    tool_change_.abandon();
}

ActionProgress ProgramActions::step() noexcept
{
    switch (phase_) {
        case Phase::kNext:
            return next();
        case Phase::kDwell:
            // A hold stops the clock of a dwell, since no slice comes here.
            return dwell_.over(core_.motion.ticks()) ? go_on(Phase::kNext) : ActionProgress::kWaits;
        case Phase::kSpindleUp:
            return core_.outputs.coming_up() ? ActionProgress::kWaits : go_on(Phase::kNext);
        case Phase::kProbe: {
            const ActionProgress progress = probe_.step();
            alarm_ = probe_.alarm();
            if (progress == ActionProgress::kLineOver) {
                phase_ = Phase::kNext;
            }
            return progress;
        }
        case Phase::kToolChange: {
            const ActionProgress progress = tool_change_.step();
            alarm_ = tool_change_.alarm();
            if (!tool_change_.active()) {
                phase_ = Phase::kNext;
            }
            return progress;
        }
    }
    return ActionProgress::kWaits;
}

// What a line has changed is stored before its next action.
ActionProgress ProgramActions::next() noexcept
{
    if (core_.keeper.wants_store()) {
        return ActionProgress::kWaits;
    }
    alarm_ = Alarm::kNone;
    if (!action_waits_ && !core_.interpreter.next(action_)) {
        return ActionProgress::kLineOver;
    }
    const ActionProgress progress =
        std::visit([this](const auto& action) { return perform(action); }, action_);
    action_waits_ = progress == ActionProgress::kWaits;
    return progress;
}

ActionProgress ProgramActions::go_on(Phase phase) noexcept
{
    phase_ = phase;
    return ActionProgress::kDone;
}

ActionProgress ProgramActions::perform(const path::Move& move) noexcept
{
    const Settings& settings = core_.settings();
    if (settings.on(Setting::kSoftLimits) && !checks() && !may_travel(move, settings)) {
        return refuse();
    }
    if (checks()) {
        return ActionProgress::kDone;
    }
    if (!core_.motion.has_room()) {
        return ActionProgress::kWaits;
    }
    path::Move numbered = move;
    if (core_.lines.line_number() > 0) {
        numbered.line = core_.lines.line_number();
    }
    numbered.power = core_.outputs.laser_power(move);
    core_.motion.push(numbered);
    if (core_.system.is(State::kIdle) || core_.system.is(State::kJog)) {
        core_.system.enter(jogs_ ? State::kJog : State::kRun);
    }
    return ActionProgress::kDone;
}

// A move beyond the travel. As in Grbl, earlier moves are stopped softly, then the alarm is raised.
ActionProgress ProgramActions::refuse() noexcept
{
    if (jogs_) {
        return ActionProgress::kLineFails;
    }
    core_.motion.hold();
    if (!core_.motion.at_rest()) {
        return ActionProgress::kWaits;
    }
    alarm_ = Alarm::kSoftLimit;
    return ActionProgress::kAlarm;
}

ActionProgress ProgramActions::perform(const gcode::Probe& probe) noexcept
{
    if (checks()) {
        return ActionProgress::kDone;
    }
    const ActionProgress progress = probe_.begin(probe);
    alarm_ = probe_.alarm();
    return progress == ActionProgress::kDone ? go_on(Phase::kProbe) : progress;
}

ActionProgress ProgramActions::perform(const gcode::Dwell& dwell) noexcept
{
    if (checks()) {
        return ActionProgress::kDone;
    }
    if (!core_.wait_settled()) {
        return ActionProgress::kWaits;
    }
    dwell_.begin(dwell.seconds, core_.motion.ticks());
    return go_on(Phase::kDwell);
}

ActionProgress ProgramActions::perform(const gcode::Spindle& spindle) noexcept
{
    if (checks()) {
        return ActionProgress::kDone;
    }
    if (!core_.outputs.changes_with_moves(spindle) && !core_.wait_settled()) {
        return ActionProgress::kWaits;
    }
    const bool comes_up = core_.outputs.set_spindle(spindle.mode, spindle.speed);
    return go_on(comes_up ? Phase::kSpindleUp : Phase::kNext);
}

ActionProgress ProgramActions::perform(const gcode::Coolant& coolant) noexcept
{
    if (checks()) {
        return ActionProgress::kDone;
    }
    if (!core_.wait_settled()) {
        return ActionProgress::kWaits;
    }
    const bool on = coolant != gcode::Coolant::kOff;
    const Accessories& before = core_.outputs.accessories();
    core_.outputs.set_coolant(on && (before.flood || coolant == gcode::Coolant::kFlood),
                              on && (before.mist || coolant == gcode::Coolant::kMist));
    return ActionProgress::kDone;
}

ActionProgress ProgramActions::perform(const gcode::ParametersChanged& changed) noexcept
{
    core_.reporter.work_offset_changed();
    if (!changed.keep || checks()) {
        return ActionProgress::kDone;
    }
    // The store is not written with frames in flight.
    if (!core_.wait_settled()) {
        return ActionProgress::kWaits;
    }
    core_.keeper.keep_parameters(core_.interpreter.parameters(), changed.tool);
    return ActionProgress::kDone;
}

ActionProgress ProgramActions::perform(const gcode::Pause& pause) noexcept
{
    const bool passes = pause.optional && !core_.settings().on(Setting::kOptionalStop);
    if (checks() || passes) {
        return ActionProgress::kDone;
    }
    if (!core_.wait_settled()) {
        return ActionProgress::kWaits;
    }
    cycle_.hold_after_line();
    return ActionProgress::kDone;
}

ActionProgress ProgramActions::perform(const gcode::ProgramEnd& /*end*/) noexcept
{
    if (!checks()) {
        if (!core_.wait_settled()) {
            return ActionProgress::kWaits;
        }
        core_.outputs.end_program();
        core_.reporter.work_offset_changed();
    }
    core_.message("Pgm End");
    return ActionProgress::kDone;
}

ActionProgress ProgramActions::perform(const gcode::ToolChange& change) noexcept
{
    if (checks()) {
        return ActionProgress::kDone;
    }
    const ActionProgress progress = tool_change_.begin(change);
    return tool_change_.active() ? go_on(Phase::kToolChange) : progress;
}

ActionProgress ProgramActions::perform(const gcode::RotaryIgnored& /*ignored*/) noexcept
{
    core_.message("A B C stand still: ignored");
    return ActionProgress::kDone;
}

}  // namespace cusp::machine
