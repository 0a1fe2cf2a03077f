// Events, each slice: alarms, realtime bytes, buttons, the link's silence.
#include "firmware/machine/machine.hpp"

namespace cusp::machine {

using protocol::RealtimeCommand;

void Machine::receive(std::uint8_t byte) noexcept
{
    if (core_.lines.receive(byte, core_.motion.ticks())) {
        act(static_cast<RealtimeCommand>(byte));
    }
}

void Machine::act(RealtimeCommand command) noexcept
{
    const SystemState& system = core_.system;
    if (const unsigned request = request_of(command); request != 0) {
        requests_.add(request);
        if (request == kRequestReset) {
            core_.lines.discard();
        } else if (request == kRequestJogCancel) {
            core_.lines.cancel(system.is(State::kJog));
        }
    } else if (command == RealtimeCommand::kFloodToggle ||
               command == RealtimeCommand::kMistToggle) {
        if (system.is(State::kIdle) || system.is(State::kRun) || system.is(State::kHold) ||
            system.is(State::kJog)) {
            core_.outputs.toggle_coolant(command);
        }
    } else {
        core_.outputs.override_by(command);
    }
}

// Takes up to one event. The order is Grbl's: alarms, reset, report, stops, start.
bool Machine::handle_events() noexcept
{
    Motion& motion = core_.motion;
    if (motion.limit_hit() && !core_.system.critical()) {
        raise(Alarm::kHardLimit);
        return true;
    }
    if (protect() || protect_drives() || protect_spindle()) {
        return true;
    }
    if (requests_.take(kRequestUnderrun)) {
        core_.message("A pulse frame was missing");
        raise(Alarm::kAbortInMotion);
        return true;
    }
    if (requests_.take(kRequestReset)) {
        reset();
        return true;
    }
    if (motion.halted() && !motion.stops().halts()) {
        raise(Alarm::kAbortInMotion);  // by what was no reset after all
        return true;
    }
    if (handle_requests() || watch_panel()) {
        return true;
    }
    if (reports_.due()) {
        reports_.write_status();
        return true;
    }
    return watch_link();
}

bool Machine::handle_requests() noexcept
{
    if (requests_.take(kRequestStatus)) {
        reports_.write_status();
    } else if (requests_.take(kRequestJogCancel)) {
        cancel_jog();
    } else if (requests_.any(kRequestHold | kRequestDoor)) {
        if (requests_.any(kRequestDoor)) {
            open_door();
        } else {
            feed_hold();
        }
        // A stop overrides a start that arrives at the same time.
        requests_.drop(kRequestHold | kRequestDoor | kRequestStart);
    } else if (requests_.take(kRequestSpindleStop)) {
        cycle_.toggle_spindle_stop();
    } else if (requests_.take(kRequestStart)) {
        cycle_.cycle_start();
    } else {
        return false;
    }
    return true;
}

// An emergency stop or a motor fault: an alarm while one is on, or after it was. After one only an
// emergency stop raises another alarm: it switches the drives off.
bool Machine::protect() noexcept
{
    Stops& stops = core_.motion.stops();
    const SystemState& system = core_.system;
    const unsigned on = core_.motion.inputs().steady() | unsigned{stops.pending()};
    const Alarm alarm = (on & kEmergencyStop) != 0 ? Alarm::kEmergencyStop
                        : (on & kMotorFault) != 0  ? Alarm::kMotorFault
                                                   : Alarm::kNone;
    const bool is_new = !system.reset_needed() ||
                        (alarm == Alarm::kEmergencyStop && system.alarm() != Alarm::kEmergencyStop);
    stops.handle(Stops::kProtecting);
    if (alarm == Alarm::kNone || !is_new) {
        return false;
    }
    raise(alarm);
    return true;
}

// After an alarm that needs a reset the drives may be without power: only what follows the reset counts.
bool Machine::protect_drives() noexcept
{
    if (!drives_.drives().fault() || core_.system.reset_needed()) {
        return false;
    }
    raise(Alarm::kMotorFault);
    return true;
}

// A spindle's drive that fails: motion is stopped softly, as before a soft limit, then the alarm is raised.
bool Machine::protect_spindle() noexcept
{
    const std::optional<vfd::FaultKind> fault = core_.outputs.vfd().fault();
    if (!fault) {
        return false;
    }
    core_.motion.hold();
    if (!core_.motion.at_rest()) {
        return false;
    }
    core_.outputs.vfd().fault_heard();
    if (!core_.system.is(State::kAlarm)) {
        raise(Alarm::kSpindle);
    }
    constexpr std::array<std::string_view, 3> kTexts{
        "does not answer", "answers with a wrong checksum", "refuses what it is told"};
    (void)core_.replies.text("[MSG:Spindle ").text(kTexts[static_cast<std::size_t>(*fault)]);
    (void)core_.replies.text("]").end_line();
    return true;
}

// Buttons and the door act when they come on.
bool Machine::watch_panel() noexcept
{
    constexpr unsigned kActing = kResetButton | kHoldButton | kStartButton | kDoor;
    Stops& stops = core_.motion.stops();
    const auto risen = static_cast<std::uint16_t>(stops.pending() & kActing);
    stops.handle(risen);
    if ((risen & kResetButton) != 0) {
        core_.lines.discard();
    }
    requests_.add(requests_of(risen));
    return risen != 0;
}

// $791: a program whose sender has gone silent is held.
bool Machine::watch_link() noexcept
{
    const std::uint32_t now = core_.motion.ticks();
    if (core_.lines.may_lapse(now) && idle()) {
        core_.lines.lapse();
    }
    const std::uint32_t patience = core_.settings().whole(Setting::kLinkWatchdog);
    if (patience == 0 || !core_.system.is(State::kRun) || core_.lines.silence(now) <= patience) {
        return false;
    }
    core_.message("Link lost: holding");
    feed_hold();
    return true;
}

void Machine::sender_left() noexcept
{
    const SystemState& system = core_.system;
    const bool may_hold = system.is(State::kIdle) || system.is(State::kRun) ||
                          system.is(State::kJog) || system.is(State::kHome);
    if (may_hold && !idle() && core_.settings().on(Setting::kHoldWhenLeft)) {
        core_.message("Link lost: holding");
        requests_.add(kRequestHold);
    }
}

bool Machine::all_answered() const noexcept
{
    return core_.lines.all_read() && !line_.waits() && line_.startup().over() &&
           !requests_.any(kRequestStatus | kRequestReset);
}

void Machine::feed_hold() noexcept
{
    if (core_.system.is(State::kJog)) {
        cancel_jog();
    } else {
        cycle_.hold();
    }
}

void Machine::open_door() noexcept
{
    const SystemState& system = core_.system;
    if (system.is(State::kAlarm) || system.is(State::kCheck) || system.is(State::kSleep)) {
        return;
    }
    core_.message("Check Door");
    if (line_.homes()) {
        raise(Alarm::kHomingDoor);
        return;
    }
    cancel_jog();
    cycle_.open_door();
}

// The jog that still waits for room must not move after the cancel.
void Machine::cancel_jog() noexcept
{
    if (!core_.system.is(State::kJog)) {
        return;
    }
    cycle_.cancel_jog();
    line_.cancel_jog();
}

}  // namespace cusp::machine
