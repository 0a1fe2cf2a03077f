// Overrides: the operator's factors on the programmed feeds and speeds.
#pragma once

#include <cstdint>

#include "firmware/protocol/realtime_command.hpp"

namespace cusp::machine {

// Per cent.
struct Overrides {
    unsigned feed{100};     // 10 to 200
    unsigned rapid{100};    // 100, 50 or 25
    unsigned spindle{100};  // 10 to 200

    friend constexpr bool operator==(const Overrides& a, const Overrides& b) noexcept
    {
        return a.feed == b.feed && a.rapid == b.rapid && a.spindle == b.spindle;
    }
};

// The overrides after a realtime command; unchanged by commands that are no override.
Overrides overridden(Overrides overrides, protocol::RealtimeCommand command) noexcept;

}  // namespace cusp::machine
