// Stops and starts of the machine: realtime bytes, buttons, the link's silence.
#include "firmware/machine/machine.hpp"

namespace cusp::machine {

using protocol::RealtimeCommand;

void Machine::receive(std::uint8_t byte) noexcept
{
    if (lines_.receive(byte, motion_.ticks())) {
        act(static_cast<RealtimeCommand>(byte));
    }
}

// Over 60 lines: one switch over all realtime bytes.
void Machine::act(RealtimeCommand command) noexcept
{
    switch (command) {
        case RealtimeCommand::kReset:
            reset_wanted_ = true;
            lines_.discard();
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
            lines_.cancel(state_ == State::kJog);
            return;
        case RealtimeCommand::kSpindleStopToggle:
            spindle_stop_wanted_ = true;
            return;
        case RealtimeCommand::kFloodToggle:
        case RealtimeCommand::kMistToggle:
            if (state_ == State::kIdle || state_ == State::kRun || state_ == State::kHold ||
                state_ == State::kJog) {
                outputs_.toggle_coolant(command);
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
    outputs_.override_by(command);
}

// Takes up to one event. The order is Grbl's: alarms, reset, report, stops, start.
bool Machine::handle_events() noexcept
{
    if (motion_.limit_hit() && !critical_) {
        raise(Alarm::kHardLimit);
        return true;
    }
    if (protect() || protect_drives() || protect_spindle()) {
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
    if (motion_.halted() && !motion_.stops().halts()) {
        raise(Alarm::kAbortInMotion);  // by what was no reset after all
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
        // A stop overrides a start that arrives at the same time.
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
    return watch_panel() || report_by_itself() || watch_link();
}

// $481: at the begin of each interval, at least 100 ms, as in grblHAL.
bool Machine::report_by_itself() noexcept
{
    constexpr std::uint32_t kLeast = 100;
    const std::uint32_t interval = stored_.settings.whole(Setting::kReportInterval);
    const std::uint32_t since = motion_.ticks() - reported_at_;
    if (interval == 0 || since < (interval < kLeast ? kLeast : interval)) {
        return false;
    }
    report_status();
    return true;
}

// An emergency stop or a motor fault. After one only an emergency stop raises another alarm: it
// switches the drives off.
bool Machine::protect() noexcept
{
    const Alarm alarm = protector();
    const bool new_one =
        !reset_needed_ || (alarm == Alarm::kEmergencyStop && alarm_ != Alarm::kEmergencyStop);
    motion_.stops().handle(Stops::kProtecting);
    if (alarm == Alarm::kNone || !new_one) {
        return false;
    }
    raise(alarm);
    return true;
}

// Buttons and the door act when they come on.
bool Machine::watch_panel() noexcept
{
    constexpr unsigned kActing = kResetButton | kHoldButton | kStartButton | kDoor;
    const auto risen = static_cast<std::uint16_t>(motion_.stops().pending() & kActing);
    motion_.stops().handle(risen);
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
    return risen != 0;
}

// $791: a program whose sender has gone silent is held.
bool Machine::watch_link() noexcept
{
    const std::uint32_t now = motion_.ticks();
    if (lines_.may_lapse(now) && idle()) {
        lines_.lapse();
    }
    const std::uint32_t patience = stored_.settings.whole(Setting::kLinkWatchdog);
    if (patience == 0 || state_ != State::kRun || lines_.silence(now) <= patience) {
        return false;
    }
    message("Link lost: holding");
    feed_hold();
    return true;
}

void Machine::sender_left() noexcept
{
    const bool may_hold = state_ == State::kIdle || state_ == State::kRun ||
                          state_ == State::kJog || state_ == State::kHome;
    if (may_hold && !idle() && stored_.settings.on(Setting::kHoldWhenLeft)) {
        message("Link lost: holding");
        hold_wanted_ = true;
    }
}

bool Machine::all_answered() const noexcept
{
    const bool lines = lines_.all_read() && task_ == Task::kNone;
    const bool startup = startup_next_ == kStartupLineCount && !answer_after_startup_;
    return lines && startup && !status_wanted_ && !reset_wanted_;
}

void Machine::feed_hold() noexcept
{
    if (state_ == State::kJog) {
        cancel_jog();
    } else {
        hold_program();
    }
}

// If nothing can move, in an alarm, a check or asleep, it means nothing. Behind a door it only
// calls off the start: what moved there is held already.
void Machine::hold_program() noexcept
{
    const bool moves = state_ == State::kIdle || state_ == State::kRun || state_ == State::kHome;
    if (moves || starting_) {
        motion_.hold();
        state_ = State::kHold;
        starting_ = false;
    }
}

// Outputs that a hold or the door has stopped are switched on again; motion continues once they are
// up.
void Machine::cycle_start() noexcept
{
    const bool closed = state_ == State::kDoor && !input_on(kDoor);
    if ((state_ != State::kHold && !closed) || !motion_.at_rest() || starting_) {
        return;
    }
    outputs_.restore();
    starting_ = true;
}

void Machine::open_door() noexcept
{
    if (state_ == State::kAlarm || state_ == State::kCheck || state_ == State::kSleep) {
        return;
    }
    message("Check Door");
    if (task_ == Task::kHome) {
        raise(Alarm::kHomingDoor);
        return;
    }
    if (state_ == State::kJog) {
        cancel_jog();
    }
    motion_.hold();
    state_ = State::kDoor;
    starting_ = false;
    outputs_.pause();
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

// In a complete hold alone. Stopped again before it was up, it calls off the start.
void Machine::toggle_spindle_stop() noexcept
{
    if (state_ != State::kHold || !motion_.at_rest() || !outputs_.can_pause_spindle()) {
        return;
    }
    if (outputs_.toggle_spindle_pause()) {
        starting_ = false;
    }
}

}  // namespace cusp::machine
