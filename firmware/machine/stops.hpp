// Stops: what stops the machine in the servo tick, whatever the main loop is doing.
//
// The tick notes what comes: an input that protects, or a byte that the main loop has not read yet. From
// then on motion brakes or halts and the outputs are cut. The main loop changes the state and answers
// the sender when it can. The tick lets go once the main loop has acted and its own outputs are in
// force: confirm().
//
// Each member has one writer, the tick or the main loop; a stop is pending while the two differ.
#pragma once

#include <atomic>
#include <cstdint>

#include "firmware/base/panel.hpp"
#include "firmware/protocol/checked_lines.hpp"

namespace cusp::machine {

class Stops {
public:
    // An alarm for as long as one is on.
    static constexpr std::uint16_t kProtecting = kEmergencyStop | kMotorFault;
    // Halt at once: that no step follows outweighs the position, as for a reset in Grbl.
    static constexpr std::uint16_t kHalting = kProtecting | kResetButton;
    // Cut spindle and coolant.
    static constexpr std::uint16_t kCutting = kHalting | kDoor;
    // Brake, from the first sample on: a glitch costs some speed, no line of the program.
    static constexpr std::uint16_t kBraking = kCutting | kHoldButton;
    // All that the main loop handles.
    static constexpr std::uint16_t kAll = kBraking | kStartButton;

    // Servo tick.

    // A byte that has come and was not read. `checked`: the line is a checked one.
    void take_byte(std::uint8_t byte, bool checked) noexcept;
    // The inputs as sampled and as they count.
    void take_inputs(std::uint16_t raw, std::uint16_t steady) noexcept;
    // Motion slows down to a stop within the limits, and stays there.
    bool brakes() const noexcept
    {
        return begins_ || (pending() & kBraking) != 0 || bytes_pending() ||
               wants_brake_.load(std::memory_order_relaxed);
    }
    // Steps end now; the position may be lost.
    bool halts() const noexcept
    {
        return (pending() & kHalting) != 0 || byte_pending(reset_byte_) ||
               wants_halt_.load(std::memory_order_relaxed);
    }
    // Spindle and coolant are off.
    bool cuts_outputs() const noexcept
    {
        return (pending() & kCutting) != 0 || byte_pending(cutting_byte_) ||
               wants_cut_.load(std::memory_order_relaxed);
    }
    // The drives are off, too.
    bool cuts_drives() const noexcept { return (pending() & kEmergencyStop) != 0; }

    // Main loop.

    // Inputs of kAll that have come on and wait.
    std::uint16_t pending() const noexcept
    {
        return static_cast<std::uint16_t>(unsigned{came_.load(std::memory_order_relaxed)} ^
                                          handled_.load(std::memory_order_relaxed));
    }
    // These were acted upon; confirm() lets them go.
    void handle(std::uint16_t inputs) noexcept
    {
        acted_ = static_cast<std::uint16_t>(acted_ | (pending() & inputs));
    }
    // Bytes that ask for a stop, so far: call this before the link is read ...
    std::uint32_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }
    // ... and this with its value once the link was found empty.
    void read_up_to(std::uint32_t bytes) noexcept { read_ = bytes; }
    // Stops that the machine has read and not yet acted upon.
    void want(bool brake, bool cut, bool halt) noexcept
    {
        wants_halt_.store(halt, std::memory_order_relaxed);
        wants_brake_.store(brake, std::memory_order_relaxed);
        wants_cut_.store(cut, std::memory_order_relaxed);
    }
    // The outputs of the machine's state are in force.
    void confirm() noexcept;

private:
    bool bytes_pending() const noexcept
    {
        return bytes_.load(std::memory_order_relaxed) !=
               bytes_handled_.load(std::memory_order_relaxed);
    }
    bool byte_pending(std::uint32_t number) const noexcept
    {
        return static_cast<std::int32_t>(number - bytes_handled_.load(std::memory_order_relaxed)) >
               0;
    }

    // The tick's.
    std::atomic<std::uint16_t> came_{0};  // a bit changes when its input comes on
    std::atomic<std::uint32_t> bytes_{0};
    std::uint32_t cutting_byte_{0};  // the last of them that cuts
    std::uint32_t reset_byte_{0};    // the last that is a reset
    std::uint16_t before_{0};
    bool begins_{false};  // an input is on that does not count yet
    protocol::RealtimeFilter filter_;
    // The main loop's.
    std::atomic<std::uint16_t> handled_{0};  // a bit changes when its input is let go
    std::atomic<std::uint32_t> bytes_handled_{0};
    std::atomic<bool> wants_halt_{false};
    std::atomic<bool> wants_brake_{false};
    std::atomic<bool> wants_cut_{false};
    std::uint16_t acted_{0};
    std::uint32_t read_{0};
};

}  // namespace cusp::machine
