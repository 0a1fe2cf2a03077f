// States, alarms and resets, and the messages about them.
#include "firmware/machine/machine.hpp"

#include "firmware/machine/report_units.hpp"

namespace cusp::machine {
namespace {

// Room for the longest output of one slice.
constexpr std::uint32_t kReplyRoom = 256;

}  // namespace

Machine::Machine(planner::PathQueue& queue,
                 const Settings* factory,
                 const BoardLimits& board) noexcept
    : factory_{factory},
      board_{board},
      motion_{queue, factory != nullptr ? *factory : stored_.settings}
{
    restore_settings();
    planner_blocks_ = motion_.free_blocks();
}

void Machine::start(LogState loaded) noexcept
{
    const bool mended = stored_.settings.mend(factory_ != nullptr ? *factory_ : Settings{}, board_);
    motion_.configure(stored_.settings);
    configure_drives();
    outputs_.configure();
    drives_.restart(motion_.ticks());
    interpreter_.set_parameters(stored_.parameters);
    interpreter_.set_default_tolerance(stored_.settings.value(Setting::kPathTolerance));
    interpreter_.set_axes(stored_.settings.axes());
    interpreter_.reset();
    const bool damaged = mended || loaded == LogState::kDamaged || loaded == LogState::kLost;
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
            lines_.answer(Error::kSettingReadFail);
            message("Settings damaged: an older set is in force");
            break;
        case LogState::kLost:
            lines_.answer(Error::kSettingReadFail);
            message("Settings lost: defaults in force, $RST=* stores them");
            break;
    }
    if (mended) {
        lines_.answer(Error::kSettingReadFail);
        message("Settings damaged: some are defaults, see $$");
    }
}

bool Machine::idle() const noexcept
{
    return task_ == Task::kNone && lines_.empty() && motion_.settled() &&
           startup_next_ == kStartupLineCount && state_ != State::kHold && state_ != State::kDoor;
}

void Machine::message(std::string_view text) noexcept
{
    (void)replies_.text("[MSG:").text(text).text("]").end_line();
}

bool Machine::suspended() const noexcept
{
    return critical_ || state_ == State::kHold || state_ == State::kDoor ||
           state_ == State::kSleep || jog_cancelled_;
}

bool Machine::poll() noexcept
{
    const bool can_answer = replies_.room() >= kReplyRoom;
    // A stop does not wait for a step of the plan.
    if (!reset_wanted_ && !door_wanted_ && !frame_missed_) {
        motion_.work(can_answer && (!lines_.empty() || task_ == Task::kActions));
    }
    guard_limits();
    // Without room for answers a stop acts in the tick meanwhile.
    const bool worked = can_answer && step();
    const bool plans = motion_.take_changes();
    return worked || plans;
}

bool Machine::step() noexcept
{
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

void Machine::end_slice() noexcept
{
    const bool cut = reset_wanted_ || door_wanted_ || frame_missed_;
    motion_.stops().want(cut || hold_wanted_, cut, reset_wanted_ || frame_missed_);
    motion_.stops().confirm();
}

// Hard limits guard every state in which something may move, from the moment that no switch is
// closed: a person must be able to drive off one.
void Machine::guard_limits() noexcept
{
    const bool moves = state_ != State::kAlarm && task_ != Task::kHome && state_ != State::kSleep &&
                       state_ != State::kCheck;
    if (!moves || !stored_.settings.on(Setting::kHardLimits)) {
        motion_.guard_limits(false);
    } else if (!limit_on()) {
        motion_.guard_limits(true);
    }
}

// Updates the state after changes that motion makes by itself.
bool Machine::follow_motion() noexcept
{
    if (!outputs_.follow()) {
        raise(Alarm::kSpindle);
        return true;
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
        case State::kHold:
            follow_hold();
            return false;
        case State::kAlarm:
        case State::kCheck:
        case State::kHome:
        case State::kSleep:
            return false;
    }
    return false;
}

// An open door keeps spindle and coolant off. A start waits until they are up.
void Machine::follow_hold() noexcept
{
    if (!motion_.at_rest()) {
        return;
    }
    starting_ = starting_ && !(state_ == State::kDoor && input_on(kDoor));
    if (state_ == State::kDoor && !starting_) {
        outputs_.pause();
    }
    if (!starting_ || outputs_.coming_up()) {
        return;
    }
    starting_ = false;
    motion_.resume();
    state_ = task_ == Task::kHome ? State::kHome : motion_.finished() ? State::kIdle : State::kRun;
}

// Discards all moves and lines in progress; the machine stays at its position.
void Machine::drop_all() noexcept
{
    motion_.abandon();
    motion_.drive(Motors::kBoth);
    motion_.guard_limits(false);
    interpreter_.discard();
    task_ = Task::kNone;
    ending_ = Ending::kAnswer;
    action_waits_ = false;
    jog_cancelled_ = false;
    hold_pending_ = false;
    starting_ = false;
    startup_next_ = kStartupLineCount;
    answer_after_startup_ = false;
    reset_after_answer_ = false;
    lines_.forget_lost_lines();
    outputs_.switch_off();
}

void Machine::raise(Alarm alarm) noexcept
{
    const bool answers =
        (task_ != Task::kNone && ending_ != Ending::kStartupLine) || answer_after_startup_;
    enter_alarm(alarm);
    if (answers) {
        lines_.answer(alarm == Alarm::kSoftLimit ? Error::kTravelExceeded : Error::kSystemGcLock);
        lines_.next();
    }
}

void Machine::enter_alarm(Alarm alarm) noexcept
{
    drop_all();
    if (loses_position(alarm)) {
        homed_ = {};
    }
    state_ = State::kAlarm;
    alarm_ = alarm;
    resynchronise();
    (void)replies_.text("ALARM:").number(static_cast<std::uint32_t>(alarm)).end_line();
    if (alarm == Alarm::kHardLimit || alarm == Alarm::kSoftLimit) {
        critical_ = true;
        message("Reset to continue");
    } else if (alarm == Alarm::kEmergencyStop || alarm == Alarm::kMotorFault) {
        reset_needed_ = true;
        if (const auto fault = drives_.fault(); fault && alarm == Alarm::kMotorFault) {
            tell_drive_fault(*fault);
            return;
        }
        // The first that a bare board says: its inputs are open.
        message(
            alarm == Alarm::kMotorFault
                ? "Motor fault: clear it, then reset. No such wire: close the input to ground or "
                  "add 256 to $14"
                : "Emergency stop: clear it, then reset. No such wire: close the input to ground "
                  "or "
                  "add 64 to $14; 331 if no control is wired");
    }
}

void Machine::frame_missed() noexcept
{
    frame_missed_ = true;
    motion_.lose_frames();
}

void Machine::reset() noexcept
{
    const bool moving = !motion_.at_rest();
    const bool homing = task_ == Task::kHome;
    const bool lock =
        state_ == State::kAlarm || state_ == State::kSleep || (state_ == State::kCheck && locked_);
    drop_all();
    critical_ = false;
    if (reset_needed_) {
        drives_.restart(motion_.ticks());  // they may have been without power
    }
    reset_needed_ = false;
    outputs_.vfd().restart();
    locked_ = false;
    lines_.forget_cancel();
    hold_wanted_ = false;
    start_wanted_ = false;
    door_wanted_ = false;
    cancel_wanted_ = false;
    outputs_.reset_overrides();
    interpreter_.reset();
    interpreter_.set_parameters(stored_.parameters);
    tool_changer_.forget_reference();
    resynchronise();
    state_ = State::kIdle;
    if (homing || moving) {
        homed_ = {};
        alarm_ = homing ? Alarm::kHomingReset : Alarm::kAbortInMotion;
        (void)replies_.text("ALARM:").number(static_cast<std::uint32_t>(alarm_)).end_line();
    }
    if (lock || homing || moving) {
        state_ = State::kAlarm;
    }
    say_hello();
}

// Sends the banner, then enters the lock, reports an open door, or runs the startup lines.
void Machine::say_hello() noexcept
{
    reporter_ = StatusReporter{};
    (void)replies_.text("\r\nGrbl 1.1h ['$' for help]").end_line();
    // Buttons pressed before are over; an open door is not.
    constexpr std::uint16_t kButtons = kResetButton | kHoldButton | kStartButton | kDoor;
    motion_.stops().handle(kButtons);
    door_wanted_ = door_wanted_ || input_on(kDoor);
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

// The interpreter continues from the machine's true position.
void Machine::resynchronise() noexcept
{
    interpreter_.discard();
    interpreter_.set_position(motion_.tail());
}

OutputLevels Machine::outputs() const noexcept
{
    const bool stopped =
        state_ == State::kSleep || alarm_ == Alarm::kEmergencyStop || !drives_.may_have_current();
    return outputs_.levels(stopped);
}

void Machine::report_status() noexcept
{
    reported_at_ = motion_.ticks();
    StatusFields status;
    status.state = state_;
    if (state_ == State::kHold) {
        status.substate = motion_.at_rest() ? 0 : 1;
    }
    if (state_ == State::kDoor) {
        const std::uint8_t stopped = input_on(kDoor) ? 1 : 0;
        status.substate = !motion_.at_rest() ? std::uint8_t{2}
                          : starting_        ? std::uint8_t{3}
                                             : stopped;
    }
    status.position = motion_.position();
    status.work_offset = gcode::work_offset(interpreter_.modal(), interpreter_.parameters());
    status.free_blocks = motion_.free_blocks();
    status.free_bytes = lines_.room();
    status.line = motion_.finished() ? 0 : motion_.executing_line();
    status.feed = motion_.speed() * kSecondsPerMinute;
    status.spindle = outputs_.spindle_speed();
    status.inputs = motion_.inputs().steady();
    const std::optional<unsigned> axis = stored_.settings.second_motor_axis();
    if (axis && input_on(kSecondLimit)) {  // by the letter of its axis
        const unsigned others = status.inputs & ~unsigned{kSecondLimit};
        status.inputs = static_cast<std::uint16_t>(others | limit_input(*axis));
    }
    status.overrides = outputs_.overrides();
    status.accessories = outputs_.accessories();
    const std::uint32_t start = replies_.place();
    reporter_.write(status, stored_.settings, replies_);
    lines_.end_report(start);
}

}  // namespace cusp::machine
