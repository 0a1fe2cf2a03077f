// SimulatedLink: the controller's serial line as two queues of bytes, with a bit rate if wanted.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "hal/contract/board.hpp"

namespace cusp::hal {

// The contract's ByteLink; members after it belong to the simulation.
class SimulatedLink {
public:
    bool try_read(std::uint8_t& byte) noexcept;
    bool try_scan(std::uint8_t& byte) noexcept;
    bool overrun() noexcept;
    std::uint32_t write_room() const noexcept;
    void write(Span<const std::uint8_t> bytes) noexcept;

    // Bytes on their way to the controller. If a bit rate is set they arrive one by one as time
    // passes.
    void send(std::string_view bytes);

    // Takes the controller's output since the last call.
    std::string take_answers();

    // Ten bits a byte, both ways; 0: no time at all.
    void set_bits_per_second(std::uint32_t rate) noexcept { bits_per_second_ = rate; }

    // One servo tick of virtual time passes on the line.
    void advance() noexcept;

    // Discards all bytes in transit, both ways: the plug is pulled or the power fails.
    void clear() noexcept;

    std::size_t unread() const noexcept { return incoming_.size(); }
    // No byte is in transit, in either direction.
    bool idle() const noexcept { return incoming_.empty() && outgoing_.empty(); }

    // Fault injection: received bytes were lost in the controller's port.
    void mark_overrun() noexcept { overrun_ = true; }

private:
    static constexpr std::uint32_t kWriteRoom = 4096;

    std::deque<std::uint8_t> incoming_;
    std::deque<std::uint8_t> outgoing_;
    std::size_t scanned_{0};  // of incoming_, from its front
    std::uint32_t bits_per_second_{0};
    // Bytes that the rate lets through now, in thousandths of a bit.
    std::uint64_t read_credit_{0};
    std::uint64_t write_credit_{0};
    bool overrun_{false};
};

static_assert(is_byte_link<SimulatedLink>());

}  // namespace cusp::hal
