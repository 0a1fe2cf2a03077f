// RealtimeRequests: what realtime bytes, buttons and the link have asked for, until the main loop does it.
#pragma once

#include <cstdint>

#include "firmware/base/panel.hpp"
#include "firmware/protocol/realtime_command.hpp"

namespace cusp::machine {

// One bit each, as in Grbl's sys_rt_exec_state.
enum Request : std::uint8_t {
    kRequestReset = 1,
    kRequestStatus = 2,
    kRequestHold = 4,
    kRequestStart = 8,
    kRequestDoor = 16,
    kRequestJogCancel = 32,
    kRequestSpindleStop = 64,
    kRequestUnderrun = 128,  // a pulse frame was missing: nobody asks, the steps have stopped
};

// The request that a realtime byte is; 0 for those that act at once.
unsigned request_of(protocol::RealtimeCommand command) noexcept;

// The requests that buttons and the door make when they come on.
unsigned requests_of(std::uint16_t inputs) noexcept;

// Context: main loop.
class RealtimeRequests {
public:
    void add(unsigned requests) noexcept { bits_ |= requests; }
    // True if any of them waits.
    bool any(unsigned requests) const noexcept { return (bits_ & requests) != 0; }
    void drop(unsigned requests) noexcept { bits_ &= ~requests; }
    // True if it waited; now it does not.
    bool take(Request request) noexcept
    {
        const bool waited = any(request);
        drop(request);
        return waited;
    }

    // Those that stop motion, and those of them that cut the outputs or halt the steps: see Stops.
    bool brake() const noexcept { return cut() || any(kRequestHold); }
    bool cut() const noexcept { return halt() || any(kRequestDoor); }
    bool halt() const noexcept { return any(kRequestReset | kRequestUnderrun); }

private:
    unsigned bits_{0};
};

}  // namespace cusp::machine
