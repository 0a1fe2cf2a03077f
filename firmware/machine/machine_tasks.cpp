// The events that a line waits for: room, the end of motion, a dwell, a probe, homing, the store.
#include "firmware/machine/machine.hpp"
#include "firmware/machine/report_units.hpp"
#include "firmware/machine/travel.hpp"

namespace cusp::machine {

bool Machine::step_task() noexcept
{
    if (waits_for_drives()) {
        return false;
    }
    switch (task_) {
        case Task::kNone:
            return false;
        case Task::kActions:
            return step_actions();
        case Task::kDwell:
            return step_dwell();
        case Task::kSpindleUp:
            return step_spindle_up();
        case Task::kProbe:
            return step_probe();
        case Task::kHome:
            return step_home();
        case Task::kToolChange:
            return step_tool_change();
        case Task::kListing:
            return step_listing();
        case Task::kConfigure:
            return step_configure();
        case Task::kFinish:
            return step_finish();
    }
    return false;
}

bool Machine::step_actions() noexcept
{
    if (store_wanted_) {
        return false;
    }
    if (!action_waits_ && !interpreter_.next(action_)) {
        finish_line(store_failed_ ? std::optional<Error>{Error::kSettingReadFail} : std::nullopt);
        return true;
    }
    action_waits_ = true;
    // Performing may end the line or continue in another task; only a wait keeps the action.
    if (perform_action()) {
        action_waits_ = false;
        return true;
    }
    return false;
}

bool Machine::perform_action() noexcept
{
    return std::visit([this](const auto& action) { return perform(action); }, action_);
}

bool Machine::wait_settled() noexcept
{
    if (motion_.settled()) {
        return true;
    }
    motion_.close();
    return false;
}

bool Machine::perform(const path::Move& move) noexcept
{
    const bool limited = stored_.settings.on(Setting::kSoftLimits) && state_ != State::kCheck;
    if (limited && !may_travel(move, stored_.settings)) {
        if (jogging_line_) {
            resynchronise();
            finish_line(Error::kTravelExceeded);
            return true;
        }
        // As in Grbl: earlier moves are stopped softly, then the alarm is raised.
        motion_.hold();
        if (!motion_.at_rest()) {
            return false;
        }
        raise(Alarm::kSoftLimit);
        return true;
    }
    if (state_ == State::kCheck) {
        return true;
    }
    if (!motion_.has_room()) {
        return false;
    }
    path::Move numbered = move;
    if (lines_.line_number() > 0) {
        numbered.line = lines_.line_number();
    }
    numbered.power = outputs_.laser_power(move);
    motion_.push(numbered);
    if (state_ == State::kIdle || state_ == State::kJog) {
        state_ = jogging_line_ ? State::kJog : State::kRun;
    }
    return true;
}

bool Machine::perform(const gcode::Probe& probe) noexcept
{
    if (state_ == State::kCheck) {
        return true;
    }
    if (!wait_settled() || !motion_.has_room()) {
        return false;
    }
    const bool on = (motion_.inputs().raw() & kProbe) != 0;
    if (on != probe.away) {
        enter_alarm(Alarm::kProbeInitial);
        finish_line(std::nullopt);
        return true;
    }
    if (stored_.settings.on(Setting::kSoftLimits) && !may_travel(probe.move, stored_.settings)) {
        raise(Alarm::kSoftLimit);
        return true;
    }
    motion_.watch({kProbe, probe.away, false});
    motion_.push(probe.move);
    motion_.close();
    state_ = State::kRun;
    probe_alarm_ = probe.alarm;
    task_ = Task::kProbe;
    return true;
}

bool Machine::step_probe() noexcept
{
    const bool found = motion_.contact().has_value();
    if (found ? !motion_.at_rest() : !motion_.settled()) {
        return false;
    }
    probe_ = {found ? *motion_.contact() : motion_.position(), found};
    motion_.abandon();
    const bool fails = !found && probe_alarm_;
    if (fails) {
        enter_alarm(Alarm::kProbeContact);
    }
    write_probe(probe_, place_form(stored_.settings), replies_);
    resynchronise();
    finish_line(std::nullopt);
    return true;
}

bool Machine::perform(const gcode::Dwell& dwell) noexcept
{
    if (state_ == State::kCheck) {
        return true;
    }
    if (!wait_settled()) {
        return false;
    }
    dwell_.begin(dwell.seconds, motion_.ticks());
    task_ = Task::kDwell;
    return true;
}

// A hold stops the clock of a dwell, since no slice comes here.
bool Machine::step_dwell() noexcept
{
    if (!dwell_.over(motion_.ticks())) {
        return false;
    }
    task_ = Task::kActions;
    return true;
}

bool Machine::perform(const gcode::Spindle& spindle) noexcept
{
    if (state_ == State::kCheck) {
        return true;
    }
    if (!outputs_.changes_with_moves(spindle) && !wait_settled()) {
        return false;
    }
    if (outputs_.set_spindle(spindle.mode, spindle.speed)) {
        task_ = Task::kSpindleUp;
    }
    return true;
}

bool Machine::step_spindle_up() noexcept
{
    if (outputs_.coming_up()) {
        return false;
    }
    task_ = Task::kActions;
    return true;
}

bool Machine::perform(const gcode::Coolant& coolant) noexcept
{
    if (state_ == State::kCheck) {
        return true;
    }
    if (!wait_settled()) {
        return false;
    }
    const bool on = coolant != gcode::Coolant::kOff;
    const Accessories& before = outputs_.accessories();
    outputs_.set_coolant(on && (before.flood || coolant == gcode::Coolant::kFlood),
                         on && (before.mist || coolant == gcode::Coolant::kMist));
    return true;
}

bool Machine::perform(const gcode::ParametersChanged& changed) noexcept
{
    reporter_.work_offset_changed();
    if (!changed.keep || state_ == State::kCheck) {
        return true;
    }
    // The store is not written with frames in flight.
    if (!wait_settled()) {
        return false;
    }
    // Lengths that were touched off hold until the reset, as their reference does.
    gcode::ToolTable tools = stored_.parameters.tools;
    stored_.parameters = interpreter_.parameters();
    if (changed.tool != 0) {
        tools.enter(changed.tool, stored_.parameters.tools.length_nm(changed.tool));
    }
    stored_.parameters.tools = tools;
    stored_.parameters.coordinate_offset = {};
    stored_.parameters.tool_length_offset_nm = 0;
    store_wanted_ = true;
    return true;
}

bool Machine::perform(const gcode::Pause& pause) noexcept
{
    const bool passes = pause.optional && !stored_.settings.on(Setting::kOptionalStop);
    if (state_ == State::kCheck || passes) {
        return true;
    }
    if (!wait_settled()) {
        return false;
    }
    hold_pending_ = true;
    return true;
}

bool Machine::perform(const gcode::RotaryIgnored& /*ignored*/) noexcept
{
    message("A B C stand still: ignored");
    return true;
}

bool Machine::perform(const gcode::ProgramEnd& /*end*/) noexcept
{
    if (state_ != State::kCheck) {
        if (!wait_settled()) {
            return false;
        }
        outputs_.end_program();
        reporter_.work_offset_changed();
    }
    message("Pgm End");
    return true;
}

bool Machine::step_home() noexcept
{
    switch (homing_.step(motion_, stored_.settings)) {
        case Homing::Progress::kWaiting:
            return false;
        case Homing::Progress::kStepped:
            return true;
        case Homing::Progress::kFailed:
            raise(homing_.alarm());
            return true;
        case Homing::Progress::kFinished:
            break;
    }
    state_ = State::kIdle;
    alarm_ = Alarm::kNone;
    resynchronise();
    task_ = Task::kNone;
    answer_after_startup_ = true;
    homed_.bits = static_cast<std::uint8_t>(homed_.bits | homing_axes_.bits);
    startup_next_ = homes_all_ ? 0 : kStartupLineCount;
    return true;
}

bool Machine::step_listing() noexcept
{
    const ListingSource source{
        stored_,         interpreter_.parameters(),         probe_,
        planner_blocks_, protocol::ReceiveQueue::kCapacity, motion_.inputs().glitches()};
    if (!write_listing_line(listing_, listing_index_, source, replies_)) {
        finish_line(std::nullopt);
        return true;
    }
    ++listing_index_;
    return true;
}

bool Machine::step_configure() noexcept
{
    if (!motion_.settled()) {
        return false;
    }
    motion_.configure(stored_.settings);
    configure_drives();
    outputs_.configure();
    interpreter_.set_default_tolerance(stored_.settings.value(Setting::kPathTolerance));
    interpreter_.set_axes(stored_.settings.axes());
    reporter_.work_offset_changed();
    task_ = Task::kFinish;
    return true;
}

bool Machine::step_finish() noexcept
{
    if (store_wanted_) {
        return false;
    }
    finish_line(store_failed_ ? std::optional<Error>{Error::kSettingReadFail} : std::nullopt);
    return true;
}

void Machine::store_done(bool written) noexcept
{
    store_wanted_ = false;
    if (!written) {
        store_failed_ = true;
        message("Settings could not be stored: they hold until power-off");
    }
}

}  // namespace cusp::machine
