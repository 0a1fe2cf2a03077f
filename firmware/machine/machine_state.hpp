// The states of the machine and its alarms, by Grbl's names and numbers.
#pragma once

#include <cstdint>

namespace cusp::machine {

enum class State : std::uint8_t {
    kIdle,
    kRun,
    kHold,
    kJog,
    kAlarm,
    kDoor,
    kCheck,
    kHome,
    kSleep,
};

enum class Alarm : std::uint8_t {
    kNone = 0,
    kHardLimit = 1,          // a limit switch was hit; the position may be lost
    kSoftLimit = 2,          // a move would leave the travel; the position is kept
    kAbortInMotion = 3,      // reset or underrun while moving; the position may be lost
    kProbeInitial = 4,       // the probe was not as it should be before its move
    kProbeContact = 5,       // the probe's move ended without contact
    kHomingReset = 6,        // reset during homing
    kHomingDoor = 7,         // the door opened during homing
    kHomingPullOff = 8,      // a switch stayed closed after the pull-off
    kHomingApproach = 9,     // no switch within the search distance
    kEmergencyStop = 10,     // grblHAL's number; the input is on until it is cleared, then a reset
    kSpindle = 14,           // grblHAL's number; the spindle did not come up in time, see $797
    kSquaringApproach = 15,  // grblHAL's number; one of an axis's two switches within $347 to $349
    kMotorFault = 17,        // grblHAL's number; a drive says that it has failed
};

// True if the position may be lost: homing makes it known again.
constexpr bool loses_position(Alarm alarm) noexcept
{
    switch (alarm) {
        case Alarm::kHardLimit:
        case Alarm::kAbortInMotion:
        case Alarm::kHomingReset:
        case Alarm::kHomingDoor:
        case Alarm::kHomingPullOff:
        case Alarm::kHomingApproach:
        case Alarm::kSquaringApproach:
        case Alarm::kEmergencyStop:
        case Alarm::kMotorFault:
            return true;
        case Alarm::kNone:
        case Alarm::kSoftLimit:
        case Alarm::kProbeInitial:
        case Alarm::kProbeContact:
        case Alarm::kSpindle:
            break;
    }
    return false;
}

}  // namespace cusp::machine
