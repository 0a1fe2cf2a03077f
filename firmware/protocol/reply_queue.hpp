// ReplyQueue: text on its way to the sender, written word by word, taken by the byte link.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "firmware/base/span.hpp"
#include "firmware/base/vec.hpp"

namespace cusp::protocol {

// Precondition of every write: room() for it; writers ask once for the longest line they make.
// Context: main loop.
class ReplyQueue {
public:
    static constexpr std::uint32_t kCapacity = 512;

    std::uint32_t room() const noexcept { return kCapacity - (head_ - tail_); }
    bool empty() const noexcept { return head_ == tail_; }

    ReplyQueue& text(std::string_view text) noexcept;
    ReplyQueue& character(char character) noexcept;
    ReplyQueue& number(std::uint32_t number) noexcept;
    // scaled / 10^decimals, with that many decimals; -0 is written 0.
    ReplyQueue& decimal(std::int64_t scaled, unsigned decimals) noexcept;
    ReplyQueue& hexadecimal(std::uint32_t number) noexcept;  // eight digits
    ReplyQueue& end_line() noexcept { return text("\r\n"); }

    // The oldest bytes that lie in one piece; empty where none wait.
    Span<const std::uint8_t> pending() const noexcept;
    // Precondition: count <= pending().size().
    void drop(std::uint32_t count) noexcept;

    // A place in the queue, and a view of every byte written since, for checks over a reply.
    std::uint32_t place() const noexcept { return head_; }
    std::uint8_t byte_at(std::uint32_t place) const noexcept { return bytes_[place % kCapacity]; }

private:
    std::array<std::uint8_t, kCapacity> bytes_{};
    std::uint32_t head_{0};
    std::uint32_t tail_{0};
};

// How places are told: so many axes of them.
struct PlaceForm {
    bool inches{false};
    unsigned axes{kLinearAxes};
};

// x,y,z with three decimals in millimetres, or four in inches; then a, in degrees.
void write_position(ReplyQueue& out, Position position, PlaceForm form) noexcept;
// One length in the form of write_position().
void write_length(ReplyQueue& out, std::int64_t nanometres, bool inches) noexcept;

// value * 10^decimals to the nearest whole number, halves away from zero.
std::int64_t scaled(float value, unsigned decimals) noexcept;

}  // namespace cusp::protocol
