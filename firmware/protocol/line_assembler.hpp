// LineAssembler: assembles bytes to a line without spaces and comments, in capitals, as Grbl does.
// The front door of `protocol`, the serial dialect of docs/protocol.md.
//
//   LineAssembler assembler;
//   while (queue.take(byte)) {                  // ReceiveQueue: bytes that wait
//       if (assembler.add(byte)) {              // a line is complete
//           if (!assembler.overflow()) { execute(assembler.line()); }
//           assembler.begin_line();
//       }
//   }
//
// Realtime bytes never come here (realtime_command.hpp). A line that begins with '$' goes to
// parse_system_command(); checked lines to CheckedLines; answers wait in a ReplyQueue.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "firmware/protocol/crc32.hpp"

namespace cusp::protocol {

inline constexpr std::size_t kMaxLineLength = 255;

// The result of the CRC at the end of a checked line.
struct LineCheck {
    bool present{false};  // the line ends in '*' and eight hexadecimal digits
    bool good{false};     // and they are the CRC-32 of every byte before the '*'
};

// Context: main loop.
class LineAssembler {
public:
    // Takes one byte of text. Returns whether it ended the line (CR or LF): the line can be read
    // until begin_line().
    bool add(std::uint8_t byte) noexcept;

    // The line without spaces, control characters, '/' and comments, in capitals.
    std::string_view line() const noexcept { return {text_.data(), length_}; }
    // The part of line() before the last '*', for checked lines.
    std::string_view checked_part() const noexcept { return {text_.data(), length_at_star_}; }
    LineCheck check() const noexcept;
    // True if part of checked_part() is lost: the check after it is then invalid.
    bool checked_part_overflow() const noexcept { return overflow_at_star_; }

    // True if more than kMaxLineLength characters came, or part of the line is known to be lost.
    // line() then holds a part only and must not be executed.
    bool overflow() const noexcept { return overflow_; }
    void mark_overflow() noexcept { overflow_ = true; }

    // True if any byte of the line has come.
    bool started() const noexcept { return started_; }

    void begin_line() noexcept;

private:
    void add_check(std::uint8_t byte) noexcept;
    void add_text(std::uint8_t byte) noexcept;

    enum class Comment : std::uint8_t { kNone, kParentheses, kToEnd };

    std::array<char, kMaxLineLength> text_{};
    std::size_t length_{0};
    std::size_t length_at_star_{0};
    Crc32 crc_;
    std::uint32_t crc_at_star_{0};
    std::uint32_t digits_value_{0};
    std::uint8_t digits_{0};
    bool digits_good_{false};
    bool star_{false};
    Comment comment_{Comment::kNone};
    bool overflow_{false};
    bool overflow_at_star_{false};
    bool started_{false};
};

}  // namespace cusp::protocol
