// ActionProgress: how far an action of a line of G-code has come.
#pragma once

#include <cstdint>

namespace cusp::machine {

enum class ActionProgress : std::uint8_t {
    kWaits,      // for room, for motion to end, for an input: try again
    kDone,       // the action is over, or goes on in steps of its own
    kLineOver,   // no action is left, or the line ends here: it is answered with "ok"
    kLineFails,  // the line ends with an error: a jog beyond the travel
    kAlarm,      // the machine stops, and the line ends with an error
};

}  // namespace cusp::machine
