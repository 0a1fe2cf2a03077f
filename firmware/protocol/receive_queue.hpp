// ReceiveQueue: the text bytes that wait to be read as lines, and a count of those lost.
#pragma once

#include <cstdint>

#include "firmware/base/spsc_ring.hpp"

namespace cusp::protocol {

// Context: main loop.
class ReceiveQueue {
public:
    static constexpr std::uint32_t kCapacity = 1024;  // all of it usable

    // Takes a text byte. If no room is left this byte and all that follow are lost, until every
    // byte before them has been read: lost() then reports it.
    void put(std::uint8_t byte) noexcept;

    // The next byte, or false where none waits. Context as put().
    bool take(std::uint8_t& byte) noexcept { return ring_.try_pop(byte); }

    bool empty() const noexcept { return ring_.empty(); }
    std::uint32_t room() const noexcept { return kCapacity - ring_.size(); }

    // True if bytes were lost after the last one taken. False while bytes wait.
    bool lost() const noexcept { return losing_ && ring_.empty(); }
    // Forgets the loss. Returns how many line ends were lost, each of which needs an answer.
    std::uint32_t take_lost_line_ends() noexcept;
    // True if the last byte lost ended a line; if not, the rest of its line is still to come.
    bool loss_ended_a_line() const noexcept { return last_lost_ended_line_; }

    // Bytes put so far and bytes taken so far: a place in the stream. Wraps.
    std::uint32_t received() const noexcept { return received_; }
    std::uint32_t taken() const noexcept { return received_ - ring_.size(); }

    void clear() noexcept;

private:
    SpscRing<std::uint8_t, kCapacity> ring_;
    std::uint32_t received_{0};
    std::uint32_t lost_line_ends_{0};
    bool losing_{false};
    bool last_lost_ended_line_{false};
};

constexpr bool is_line_end(std::uint8_t byte) noexcept { return byte == '\n' || byte == '\r'; }

}  // namespace cusp::protocol
