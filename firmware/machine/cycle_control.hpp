// CycleControl: begins and ends what moves: the cycle (Run), feed hold, the door, jog cancel, spindle stop.
//
// A hold ends by cycle_start(): the outputs that it has stopped come up, then motion goes on.
#pragma once

#include <cstdint>

#include "firmware/machine/machine_core.hpp"

namespace cusp::machine {

// Context: main loop.
class CycleControl {
public:
    // `core` must outlive this.
    explicit CycleControl(MachineCore& core) noexcept : core_{core} {}

    // Nothing goes on: a hold, an open door, sleep, a jog that is being cancelled, an alarm of a limit.
    bool suspended() const noexcept;
    // Of Hold and Door, as Grbl numbers them.
    std::uint8_t substate() const noexcept;

    // Feed hold. If nothing can move, in an alarm, a check or asleep, it means nothing. Behind a door it
    // only calls off the start: what moved there is held already.
    void hold() noexcept;
    // As above, once the line is answered: M0, M6.
    void hold_after_line() noexcept { hold_pending_ = true; }
    // The line was answered.
    void line_answered() noexcept;
    // Motion slows down and the outputs pause. Precondition: no jog moves that is not cancelled.
    void open_door() noexcept;
    // The jog that moves is given up. Precondition: State::kJog.
    void cancel_jog() noexcept;
    // Outputs that a hold or the door has stopped are switched on again; motion continues once they are
    // up.
    void cycle_start() noexcept;
    // The spindle off and on, in a complete hold alone. Stopped again before it was up, it calls off the start.
    void toggle_spindle_stop() noexcept;

    // Updates the state after changes that motion makes by itself. True if a jog's cancel is complete.
    //
    //   waits  a line waits for what it began
    //   homes  it is a cycle of homing
    bool follow(bool waits, bool homes) noexcept;

    // Everything is discarded.
    void forget() noexcept;

private:
    void end_cancel() noexcept;
    void follow_hold(bool homes) noexcept;

    MachineCore& core_;
    bool hold_pending_{false};  // it begins once the line is answered
    bool jog_cancelled_{false};
    bool starting_{false};  // a cycle start waits for what comes up
};

}  // namespace cusp::machine
