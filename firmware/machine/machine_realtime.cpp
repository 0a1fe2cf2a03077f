// Stops and starts of the machine: realtime bytes, buttons, the link's silence.
#include "firmware/machine/machine.hpp"

namespace cusp::machine {

using protocol::RealtimeCommand;

void Machine::receive(std::uint8_t byte) noexcept
{
    last_byte_tick_ = motion_.ticks();
    switch (protocol::byte_kind(byte)) {
        case protocol::ByteKind::kDropped:
            return;
        case protocol::ByteKind::kText:
            last_text_tick_ = last_byte_tick_;
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

// Over 60 lines: one switch over all realtime bytes.
void Machine::act(RealtimeCommand command) noexcept
{
    switch (command) {
        case RealtimeCommand::kReset:
            reset_wanted_ = true;
            // Bytes before the reset are discarded; bytes after it are not.
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
            toggle_coolant(command);
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
// Takes up to one event. The order is Grbl's: alarms, reset, report, stops, start.
bool Machine::handle_events() noexcept
{
    if (motion_.limit_hit() && !critical_) {
        raise(Alarm::kHardLimit);
        return true;
    }
    if (protect()) {
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
    return watch_panel() || watch_link();
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

// $791: a program whose sender has gone silent is held. Checked lines lapse in a long silence at
// rest, so that a stock sender finds a stock controller.
bool Machine::watch_link() noexcept
{
    constexpr std::uint32_t kCheckedLinesLapse = 3000;  // ticks
    const std::uint32_t silence = motion_.ticks() - last_byte_tick_;
    // Status queries are no lines: senders send them all the time.
    const bool no_lines = motion_.ticks() - last_text_tick_ > kCheckedLinesLapse;
    if (checked_.on() && no_lines && idle()) {
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
    const bool lines = received_.empty() && lost_answers_ == 0 && task_ == Task::kNone;
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
    if (accessories_.spindle_paused || accessories_.coolant_paused) {
        accessories_.spindle_paused = false;
        accessories_.coolant_paused = false;
        reporter_.overrides_changed();
        wait_until_up(restoring_ticks(accessories_, stored_.settings));
    }
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
    pause_outputs();
}

void Machine::pause_outputs() noexcept
{
    accessories_.spindle_paused = true;
    accessories_.coolant_paused = true;
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
    if (state_ != State::kHold || !motion_.at_rest() || accessories_.changing_tool ||
        accessories_.spindle == gcode::SpindleMode::kOff) {
        return;
    }
    accessories_.spindle_paused = !accessories_.spindle_paused;
    reporter_.overrides_changed();
    if (accessories_.spindle_paused) {
        starting_ = false;
    } else {
        wait_until_up(restoring_ticks(accessories_, stored_.settings));
    }
}

// The operator's M7, M8 and M9.
void Machine::toggle_coolant(RealtimeCommand command) noexcept
{
    if (state_ != State::kIdle && state_ != State::kRun && state_ != State::kHold &&
        state_ != State::kJog) {
        return;
    }
    const bool flood = accessories_.flood;
    const bool mist = accessories_.mist;
    const bool of_flood = command == RealtimeCommand::kFloodToggle;
    switch_coolant(of_flood ? !flood : flood, of_flood ? mist : !mist);
}

void Machine::switch_coolant(bool flood, bool mist) noexcept
{
    accessories_.flood = flood;
    accessories_.mist = mist;
    interpreter_.set_coolant(flood, mist);
    reporter_.overrides_changed();
}

void Machine::switch_off() noexcept
{
    accessories_ = Accessories{};
    coming_up_ = false;
    interpreter_.set_coolant(false, false);
    interpreter_.set_spindle_off();
    reporter_.overrides_changed();
}

// Time that the outputs switched on take to come up; nothing moves meanwhile.
void Machine::wait_until_up(std::uint32_t ticks) noexcept
{
    coming_up_ = true;
    up_at_ = motion_.ticks() + ticks;
}

}  // namespace cusp::machine
