// Holds and starts, and the states between them.
#include "firmware/machine/cycle_control.hpp"

namespace cusp::machine {

bool CycleControl::suspended() const noexcept
{
    const SystemState& system = core_.system;
    return system.critical() || system.is(State::kHold) || system.is(State::kDoor) ||
           system.is(State::kSleep) || jog_cancelled_;
}

std::uint8_t CycleControl::substate() const noexcept
{
    const bool rests = core_.motion.at_rest();
    if (core_.system.is(State::kHold)) {
        return rests ? 0 : 1;
    }
    if (!core_.system.is(State::kDoor)) {
        return 0;
    }
    const std::uint8_t stopped = core_.input_on(kDoor) ? 1 : 0;
    return !rests ? std::uint8_t{2} : starting_ ? std::uint8_t{3} : stopped;
}

void CycleControl::hold() noexcept
{
    const SystemState& system = core_.system;
    const bool moves = system.is(State::kIdle) || system.is(State::kRun) || system.is(State::kHome);
    if (moves || starting_) {
        core_.motion.hold();
        core_.system.enter(State::kHold);
        starting_ = false;
    }
}

void CycleControl::line_answered() noexcept
{
    if (hold_pending_) {
        hold_pending_ = false;
        hold();
    }
}

void CycleControl::open_door() noexcept
{
    core_.motion.hold();
    core_.system.enter(State::kDoor);
    starting_ = false;
    core_.outputs.pause();
}

void CycleControl::cancel_jog() noexcept
{
    core_.motion.hold();
    jog_cancelled_ = true;
}

void CycleControl::cycle_start() noexcept
{
    const SystemState& system = core_.system;
    const bool closed = system.is(State::kDoor) && !core_.input_on(kDoor);
    if ((!system.is(State::kHold) && !closed) || !core_.motion.at_rest() || starting_) {
        return;
    }
    core_.outputs.restore();
    starting_ = true;
}

void CycleControl::toggle_spindle_stop() noexcept
{
    if (!core_.system.is(State::kHold) || !core_.motion.at_rest() ||
        !core_.outputs.can_pause_spindle()) {
        return;
    }
    if (core_.outputs.toggle_spindle_pause()) {
        starting_ = false;
    }
}

bool CycleControl::follow(bool waits, bool homes) noexcept
{
    if (jog_cancelled_) {
        if (!core_.motion.at_rest()) {
            return false;
        }
        end_cancel();
        return true;
    }
    switch (core_.system.state()) {
        case State::kIdle:
            if (!core_.motion.finished()) {
                core_.system.enter(State::kRun);
            }
            break;
        case State::kRun:
            if (core_.motion.settled()) {
                core_.system.enter(State::kIdle);
            }
            break;
        case State::kJog:
            if (core_.motion.settled() && !waits) {
                core_.system.enter(State::kIdle);
            }
            break;
        case State::kDoor:
        case State::kHold:
            follow_hold(homes);
            break;
        case State::kAlarm:
        case State::kCheck:
        case State::kHome:
        case State::kSleep:
            break;
    }
    return false;
}

void CycleControl::end_cancel() noexcept
{
    core_.motion.abandon();
    jog_cancelled_ = false;
    if (core_.system.is(State::kJog)) {
        core_.system.enter(State::kIdle);
    } else {
        core_.motion.hold();
    }
    core_.resynchronise();
}

// An open door keeps spindle and coolant off. A start waits until they are up.
void CycleControl::follow_hold(bool homes) noexcept
{
    if (!core_.motion.at_rest()) {
        return;
    }
    const bool door = core_.system.is(State::kDoor);
    starting_ = starting_ && !(door && core_.input_on(kDoor));
    if (door && !starting_) {
        core_.outputs.pause();
    }
    if (!starting_ || core_.outputs.coming_up()) {
        return;
    }
    starting_ = false;
    core_.motion.resume();
    core_.system.enter(homes ? State::kHome : core_.motion.finished() ? State::kIdle : State::kRun);
}

void CycleControl::forget() noexcept
{
    hold_pending_ = false;
    jog_cancelled_ = false;
    starting_ = false;
}

}  // namespace cusp::machine
