// SystemState: the state of the machine, its alarm, what locks it, and which axes are homed.
#pragma once

#include "firmware/base/axis.hpp"
#include "firmware/machine/machine_state.hpp"

namespace cusp::machine {

// Context: main loop.
class SystemState {
public:
    State state() const noexcept { return state_; }
    bool is(State state) const noexcept { return state_ == state; }
    void enter(State state) noexcept { state_ = state; }

    // The last alarm, until clear_alarm().
    Alarm alarm() const noexcept { return alarm_; }
    // Enters the alarm; axes whose position may be lost are no longer homed.
    void raise(Alarm alarm) noexcept
    {
        state_ = State::kAlarm;
        alarm_ = alarm;
        if (loses_position(alarm)) {
            homed_ = {};
        }
        critical_ = critical_ || alarm == Alarm::kHardLimit || alarm == Alarm::kSoftLimit;
        reset_needed_ =
            reset_needed_ || alarm == Alarm::kEmergencyStop || alarm == Alarm::kMotorFault;
    }
    // Idle and without an alarm: unlocked, homed, or after a reset.
    void clear_alarm() noexcept
    {
        state_ = State::kIdle;
        alarm_ = Alarm::kNone;
    }
    // Check mode; a reset leads back to the alarm that it was entered from.
    void enter_check() noexcept
    {
        locked_ = state_ == State::kAlarm;
        state_ = State::kCheck;
    }
    // A reset: idle, but an alarm and sleep stay locked. `aborted`: what it has broken off, kNone where
    // nothing moved.
    void reset(Alarm aborted) noexcept
    {
        const bool locked = state_ == State::kAlarm || state_ == State::kSleep ||
                            (state_ == State::kCheck && locked_);
        state_ = State::kIdle;
        critical_ = false;
        reset_needed_ = false;
        locked_ = false;
        if (aborted != Alarm::kNone) {
            raise(aborted);
        } else if (locked) {
            state_ = State::kAlarm;
        }
    }

    // After a limit alarm: only a reset is accepted.
    bool critical() const noexcept { return critical_; }
    // After an emergency stop or a motor fault: no motion before a reset.
    bool reset_needed() const noexcept { return reset_needed_; }

    // Axes homed since the position was lost last.
    AxisMask homed() const noexcept { return homed_; }
    void add_homed(AxisMask axes) noexcept
    {
        homed_.bits = static_cast<std::uint8_t>(homed_.bits | axes.bits);
    }

private:
    State state_{State::kIdle};
    Alarm alarm_{Alarm::kNone};
    bool critical_{false};
    bool reset_needed_{false};
    bool locked_{false};  // check mode was entered from an alarm
    AxisMask homed_;
};

}  // namespace cusp::machine
