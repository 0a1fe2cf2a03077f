// CheckedLines: lines with a number and a CRC, so that a bad serial line can't cut a wrong part.
//
//   N<number> <G-code or $ command>*<CRC-32 of all before the '*', eight hexadecimal digits>
//
// A line runs only if its CRC is right and its number is the one expected: each runs exactly once
// and in order. Everything else is refused with the number expected. docs/protocol.md has a worked
// dump.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string_view>

#include "firmware/protocol/line_assembler.hpp"

namespace cusp::protocol {

// Which realtime bytes count on a checked line. Noise could make one of a text byte, so all but '?'
// count at their third repetition in a row. Context: one for each reader of the bytes.
class RealtimeFilter {
public:
    bool accept(std::uint8_t byte) noexcept;
    // A byte of text came in between.
    void text() noexcept { repetitions_ = 0; }

private:
    static constexpr std::uint8_t kRepetitions = 3;

    std::uint8_t last_{0};
    std::uint8_t repetitions_{0};
};

// Context: main loop, but for on().
class CheckedLines {
public:
    // Context: any.
    bool on() const noexcept { return on_.load(std::memory_order_relaxed); }
    // The number that the next line must carry.
    std::uint32_t expected() const noexcept { return expected_; }

    // From now on lines are checked; the first is number 1.
    void switch_on() noexcept;
    void switch_off() noexcept { on_.store(false, std::memory_order_relaxed); }

    // The command of a complete line, without number and check: the line then counts as run,
    // and the next number is expected. None: refuse it with expected(). Precondition: on().
    std::optional<std::string_view> accept(const LineAssembler& line) noexcept;

    // True if a realtime byte counts; call text() for text bytes in between.
    bool accept_realtime(std::uint8_t byte) noexcept { return !on() || filter_.accept(byte); }
    void text() noexcept { filter_.text(); }

private:
    std::uint32_t expected_{1};
    std::atomic<bool> on_{false};
    RealtimeFilter filter_;
};

}  // namespace cusp::protocol
