// States, realtime commands, alarms and resets.
#include "firmware/machine/machine.hpp"

namespace cusp::machine {
namespace {

using protocol::RealtimeCommand;

// Room for the longest single thing that a slice writes.
constexpr std::uint32_t kReplyRoom = 256;

}  // namespace

Machine::Machine(const Settings& factory) noexcept : factory_{factory}, motion_{factory}
{
    stored_.settings = factory;
    planner_blocks_ = motion_.free_blocks();
}

void Machine::start(LogState loaded) noexcept
{
    motion_.configure(stored_.settings);
    interpreter_.set_parameters(stored_.parameters);
    interpreter_.set_default_tolerance(stored_.settings.value(Setting::kPathTolerance));
    interpreter_.reset();
    const bool damaged = loaded == LogState::kDamaged || loaded == LogState::kLost;
    if (damaged || stored_.settings.on(Setting::kHoming)) {
        state_ = State::kAlarm;
    }
    say_hello();
    switch (loaded) {
        case LogState::kEmpty:
        case LogState::kGood:
            break;
        case LogState::kInterrupted:
            message("Settings: an interrupted write was dropped");
            break;
        case LogState::kDamaged:
            answer(Error::kSettingReadFail);
            message("Settings damaged: an older set is in force");
            break;
        case LogState::kLost:
            answer(Error::kSettingReadFail);
            message("Settings lost: defaults in force, $RST=* stores them");
            break;
    }
}

bool Machine::idle() const noexcept
{
    return task_ == Task::kNone && received_.empty() && motion_.settled() &&
           startup_next_ == kStartupLineCount && state_ != State::kHold && state_ != State::kDoor;
}

void Machine::message(std::string_view text) noexcept
{
    (void)replies_.text("[MSG:").text(text).text("]").end_line();
}

void Machine::receive(std::uint8_t byte) noexcept
{
    last_byte_tick_ = motion_.ticks();
    switch (protocol::byte_kind(byte)) {
        case protocol::ByteKind::kDropped:
            return;
        case protocol::ByteKind::kText:
            checked_.text();
            received_.put(byte);
            return;
        case protocol::ByteKind::kRealtime:
            break;
    }
    if (checked_.accept_realtime(byte)) {
        act(static_cast<RealtimeCommand>(byte));
    }
}

void Machine::act(RealtimeCommand command) noexcept
{
    switch (command) {
        case RealtimeCommand::kReset:
            reset_wanted_ = true;
            // What came before the reset is forgotten; what comes after it is not.
            received_.clear();
            line_.begin_line();
            checked_.switch_off();
            return;
        case RealtimeCommand::kStatusReport:
            status_wanted_ = true;
            return;
        case RealtimeCommand::kFeedHold:
            hold_wanted_ = true;
            return;
        case RealtimeCommand::kCycleStart:
            start_wanted_ = true;
            return;
        case RealtimeCommand::kSafetyDoor:
            door_wanted_ = true;
            return;
        case RealtimeCommand::kJogCancel:
            cancel_wanted_ = true;
            cancelling_ = true;
            cancelled_to_ = received_.received();
            cancelled_in_jog_ = state_ == State::kJog;
            return;
        case RealtimeCommand::kSpindleStopToggle:
            spindle_stop_wanted_ = true;
            return;
        case RealtimeCommand::kFloodToggle:
        case RealtimeCommand::kMistToggle:
            if (state_ == State::kIdle || state_ == State::kRun || state_ == State::kHold) {
                bool& output = command == RealtimeCommand::kFloodToggle ? accessories_.flood
                                                                        : accessories_.mist;
                output = !output;
                reporter_.overrides_changed();
            }
            return;
        case RealtimeCommand::kFeedOverrideReset:
        case RealtimeCommand::kFeedOverrideCoarsePlus:
        case RealtimeCommand::kFeedOverrideCoarseMinus:
        case RealtimeCommand::kFeedOverrideFinePlus:
        case RealtimeCommand::kFeedOverrideFineMinus:
        case RealtimeCommand::kRapidOverrideReset:
        case RealtimeCommand::kRapidOverrideMedium:
        case RealtimeCommand::kRapidOverrideLow:
        case RealtimeCommand::kSpindleOverrideReset:
        case RealtimeCommand::kSpindleOverrideCoarsePlus:
        case RealtimeCommand::kSpindleOverrideCoarseMinus:
        case RealtimeCommand::kSpindleOverrideFinePlus:
        case RealtimeCommand::kSpindleOverrideFineMinus:
            break;
    }
    const Overrides before = overrides_;
    overrides_ = overridden(overrides_, command);
    if (!(before == overrides_)) {
        motion_.set_overrides(overrides_.feed, overrides_.rapid);
        reporter_.overrides_changed();
    }
}

bool Machine::suspended() const noexcept
{
    return critical_ || state_ == State::kHold || state_ == State::kDoor ||
           state_ == State::kSleep || jog_cancelled_;
}

bool Machine::poll() noexcept
{
    const bool can_answer = replies_.room() >= kReplyRoom;
    motion_.work(can_answer && (!received_.empty() || task_ == Task::kActions));
    guard_limits();
    if (!can_answer) {
        // Though the sender does not listen, a stop is a stop.
        if (hold_wanted_ || door_wanted_ || reset_wanted_) {
            motion_.hold();
        }
        return false;
    }
    const bool handled = handle_events();
    const bool followed = follow_motion();
    if (handled || followed) {
        return true;
    }
    if (suspended()) {
        return false;
    }
    if (task_ != Task::kNone) {
        return step_task();
    }
    if (startup_next_ < kStartupLineCount || answer_after_startup_) {
        next_startup_line();
        return true;
    }
    return read_lines();
}

// Hard limits guard every state in which something may move, from the moment that no switch is
// closed: a person must be able to drive off one.
void Machine::guard_limits() noexcept
{
    const bool moves = state_ != State::kAlarm && state_ != State::kHome &&
                       state_ != State::kSleep && state_ != State::kCheck;
    if (!moves || !stored_.settings.on(Setting::kHardLimits)) {
        motion_.guard_limits(false);
    } else if (!limit_on()) {
        motion_.guard_limits(true);
    }
}

// Takes up to one event. The order is Grbl's: alarms, reset, report, stops, start.
bool Machine::handle_events() noexcept
{
    if (motion_.limit_hit() && !critical_) {
        raise(Alarm::kHardLimit);
        return true;
    }
    if (frame_missed_) {
        frame_missed_ = false;
        message("A pulse frame was missing");
        raise(Alarm::kAbortInMotion);
        return true;
    }
    if (reset_wanted_) {
        reset_wanted_ = false;
        reset();
        return true;
    }
    if (status_wanted_) {
        status_wanted_ = false;
        report_status();
        return true;
    }
    if (cancel_wanted_) {
        cancel_wanted_ = false;
        cancel_jog();
        return true;
    }
    if (hold_wanted_ || door_wanted_) {
        // A start that came at the same time as a stop is not meant.
        start_wanted_ = false;
        if (door_wanted_) {
            open_door();
        } else {
            feed_hold();
        }
        hold_wanted_ = false;
        door_wanted_ = false;
        return true;
    }
    if (spindle_stop_wanted_) {
        spindle_stop_wanted_ = false;
        toggle_spindle_stop();
        return true;
    }
    if (start_wanted_) {
        start_wanted_ = false;
        cycle_start();
        return true;
    }
    return watch_panel() || watch_link();
}

// Buttons and the door act when they come on.
bool Machine::watch_panel() noexcept
{
    const std::uint16_t now = motion_.inputs().steady();
    const auto risen = static_cast<std::uint16_t>(now & ~unsigned{panel_before_});
    panel_before_ = now;
    if ((risen & kResetButton) != 0) {
        act(RealtimeCommand::kReset);
    }
    if ((risen & kHoldButton) != 0) {
        hold_wanted_ = true;
    }
    if ((risen & kStartButton) != 0) {
        start_wanted_ = true;
    }
    if ((risen & kDoor) != 0) {
        door_wanted_ = true;
    }
    return (risen & (kResetButton | kHoldButton | kStartButton | kDoor)) != 0;
}

// $791: a program whose sender has gone silent is held. Checked lines lapse in a long silence at
// rest, so that a stock sender finds a stock controller.
bool Machine::watch_link() noexcept
{
    constexpr std::uint32_t kCheckedLinesLapse = 3000;  // ticks
    const std::uint32_t silence = motion_.ticks() - last_byte_tick_;
    if (checked_.on() && silence > kCheckedLinesLapse && idle()) {
        checked_.switch_off();
        line_.begin_line();
    }
    const std::uint32_t patience = stored_.settings.whole(Setting::kLinkWatchdog);
    if (patience == 0 || state_ != State::kRun || silence <= patience) {
        return false;
    }
    message("Link lost: holding");
    feed_hold();
    return true;
}

void Machine::feed_hold() noexcept
{
    if (state_ == State::kJog) {
        cancel_jog();
    } else {
        hold_program();
    }
}

void Machine::hold_program() noexcept
{
    if (state_ == State::kIdle || state_ == State::kRun) {
        motion_.hold();
        state_ = State::kHold;
    }
}

void Machine::cycle_start() noexcept
{
    if (state_ == State::kDoor && motion_.at_rest() && !input_on(kDoor) && !door_restoring_) {
        // The spindle comes up to speed before the tool moves, as Grbl waits.
        constexpr std::uint32_t kSpindleUp = 4000;  // ticks
        constexpr std::uint32_t kCoolantOn = 1000;
        const bool spindle = accessories_.spindle != gcode::SpindleMode::kOff;
        const bool coolant = accessories_.flood || accessories_.mist;
        accessories_.spindle_paused = false;
        accessories_.coolant_paused = false;
        door_restoring_ = true;
        door_restored_at_ = motion_.ticks() + (spindle ? kSpindleUp : coolant ? kCoolantOn : 0U);
        return;
    }
    if (state_ == State::kHold && motion_.at_rest()) {
        accessories_.spindle_paused = false;
        motion_.resume();
        state_ = motion_.finished() ? State::kIdle : State::kRun;
    }
}

void Machine::open_door() noexcept
{
    if (state_ == State::kAlarm || state_ == State::kCheck || state_ == State::kSleep) {
        return;
    }
    message("Check Door");
    if (state_ == State::kHome) {
        raise(Alarm::kHomingDoor);
        return;
    }
    if (state_ == State::kJog) {
        cancel_jog();
    }
    motion_.hold();
    state_ = State::kDoor;
    door_restoring_ = false;
}

void Machine::cancel_jog() noexcept
{
    if (state_ != State::kJog) {
        return;
    }
    motion_.hold();
    jog_cancelled_ = true;
    if (task_ == Task::kActions && jogging_line_) {
        // The jog that still waits for room must not move after the cancel.
        interpreter_.discard();
        action_waits_ = false;
        finish_line(std::nullopt);
    }
}

void Machine::toggle_spindle_stop() noexcept
{
    if (state_ != State::kHold || !motion_.at_rest() ||
        accessories_.spindle == gcode::SpindleMode::kOff) {
        return;
    }
    accessories_.spindle_paused = !accessories_.spindle_paused;
    reporter_.overrides_changed();
}

// Takes the state along with what motion does by itself.
bool Machine::follow_motion() noexcept
{
    if (!motion_.settled()) {
        still_since_ = motion_.ticks();
    }
    if (jog_cancelled_) {
        if (!motion_.at_rest()) {
            return false;
        }
        motion_.abandon();
        jog_cancelled_ = false;
        if (state_ == State::kJog) {
            state_ = State::kIdle;
        } else {
            motion_.hold();
        }
        resynchronise();
        return true;
    }
    switch (state_) {
        case State::kIdle:
            if (!motion_.finished()) {
                state_ = State::kRun;
            }
            return false;
        case State::kRun:
            if (motion_.settled()) {
                state_ = State::kIdle;
            }
            return false;
        case State::kJog:
            if (motion_.settled() && task_ == Task::kNone) {
                state_ = State::kIdle;
            }
            return false;
        case State::kDoor:
            follow_door();
            return false;
        case State::kHold:
        case State::kAlarm:
        case State::kCheck:
        case State::kHome:
        case State::kSleep:
            return false;
    }
    return false;
}

void Machine::follow_door() noexcept
{
    if (!motion_.at_rest()) {
        return;
    }
    if (door_restoring_ && input_on(kDoor)) {
        door_restoring_ = false;
    }
    if (!door_restoring_) {
        accessories_.spindle_paused = true;
        accessories_.coolant_paused = true;
        return;
    }
    if (static_cast<std::int32_t>(motion_.ticks() - door_restored_at_) >= 0) {
        door_restoring_ = false;
        motion_.resume();
        state_ = motion_.finished() ? State::kIdle : State::kRun;
    }
}

// Everything that was under way is forgotten; the machine stands where it is.
void Machine::drop_all() noexcept
{
    motion_.abandon();
    motion_.guard_limits(false);
    interpreter_.discard();
    task_ = Task::kNone;
    ending_ = Ending::kAnswer;
    action_waits_ = false;
    jog_cancelled_ = false;
    hold_pending_ = false;
    door_restoring_ = false;
    startup_next_ = kStartupLineCount;
    answer_after_startup_ = false;
    reset_after_answer_ = false;
    lost_answers_ = 0;
    accessories_ = Accessories{};
}

void Machine::raise(Alarm alarm) noexcept
{
    const bool answers =
        (task_ != Task::kNone && ending_ != Ending::kStartupLine) || answer_after_startup_;
    enter_alarm(alarm);
    if (answers) {
        answer(alarm == Alarm::kSoftLimit ? Error::kTravelExceeded : Error::kSystemGcLock);
        line_.begin_line();
    }
}

void Machine::enter_alarm(Alarm alarm) noexcept
{
    drop_all();
    state_ = State::kAlarm;
    alarm_ = alarm;
    resynchronise();
    (void)replies_.text("ALARM:").number(static_cast<std::uint32_t>(alarm)).end_line();
    if (alarm == Alarm::kHardLimit || alarm == Alarm::kSoftLimit) {
        critical_ = true;
        message("Reset to continue");
    }
}

void Machine::frame_missed() noexcept { frame_missed_ = true; }

void Machine::reset() noexcept
{
    const bool moving = !motion_.at_rest();
    const bool homing = state_ == State::kHome;
    const bool lock =
        state_ == State::kAlarm || state_ == State::kSleep || (state_ == State::kCheck && locked_);
    drop_all();
    critical_ = false;
    locked_ = false;
    cancelling_ = false;
    hold_wanted_ = false;
    start_wanted_ = false;
    door_wanted_ = false;
    cancel_wanted_ = false;
    overrides_ = Overrides{};
    motion_.set_overrides(overrides_.feed, overrides_.rapid);
    interpreter_.reset();
    interpreter_.set_parameters(stored_.parameters);
    resynchronise();
    state_ = State::kIdle;
    if (homing || moving) {
        alarm_ = homing ? Alarm::kHomingReset : Alarm::kAbortInMotion;
        (void)replies_.text("ALARM:").number(static_cast<std::uint32_t>(alarm_)).end_line();
    }
    if (lock || homing || moving) {
        state_ = State::kAlarm;
    }
    say_hello();
}

// The banner, and what follows it: a lock, an open door, or the startup lines.
void Machine::say_hello() noexcept
{
    reporter_ = StatusReporter{};
    (void)replies_.text("\r\nGrbl 1.1h ['$' for help]").end_line();
    panel_before_ = static_cast<std::uint16_t>(motion_.inputs().steady() & ~unsigned{kDoor});
    if (stored_.settings.on(Setting::kHardLimits) && limit_on()) {
        state_ = State::kAlarm;
        message("Check Limits");
    }
    if (state_ == State::kAlarm) {
        message("'$H'|'$X' to unlock");
        return;
    }
    alarm_ = Alarm::kNone;
    state_ = State::kIdle;
    startup_next_ = 0;
}

// The interpreter goes on from where the machine really is.
void Machine::resynchronise() noexcept
{
    interpreter_.discard();
    interpreter_.set_position(motion_.tail());
}

OutputLevels Machine::outputs() const noexcept
{
    // $1: the drives stay on that long after the last step; 255 is for ever.
    constexpr std::uint32_t kAlwaysOn = 255;
    const std::uint32_t idle_lock = stored_.settings.whole(Setting::kIdleLock);
    const bool still = motion_.settled() && motion_.ticks() - still_since_ >= idle_lock;
    const bool drives = state_ != State::kSleep && (idle_lock == kAlwaysOn || !still);
    Accessories accessories = accessories_;
    if (state_ == State::kSleep) {
        accessories = Accessories{};
    }
    return output_levels(accessories, overrides_.spindle, drives, stored_.settings);
}

void Machine::report_status() noexcept
{
    constexpr float kSecondsPerMinute = 60.0F;
    StatusFields status;
    status.state = state_;
    if (state_ == State::kHold) {
        status.substate = motion_.at_rest() ? 0 : 1;
    }
    if (state_ == State::kDoor) {
        const std::uint8_t stopped = input_on(kDoor) ? 1 : 0;
        status.substate = !motion_.at_rest() ? std::uint8_t{2}
                          : door_restoring_  ? std::uint8_t{3}
                                             : stopped;
    }
    status.position = motion_.position();
    status.work_offset = gcode::work_offset(interpreter_.modal(), interpreter_.parameters());
    status.free_blocks = motion_.free_blocks();
    status.free_bytes = received_.room();
    status.line = motion_.finished() ? 0 : motion_.executing_line();
    status.feed = motion_.speed() * kSecondsPerMinute;
    status.spindle = spindle_speed(accessories_, overrides_.spindle, stored_.settings);
    status.inputs = motion_.inputs().steady();
    status.overrides = overrides_;
    status.accessories = accessories_;
    reporter_.write(status, stored_.settings, replies_);
}

}  // namespace cusp::machine
