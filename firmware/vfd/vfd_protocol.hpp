// The words of three kinds of spindle drives: what is asked of them, as messages, and what they answer.
//
//   Huanyang      the old ones: functions of their own, speeds as hundredths of a hertz
//   Huanyang P2A  registers, speeds as ten-thousandths of the greatest
//   plain         Modbus as it is meant: registers, words and scales by settings 462 to 471
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/vfd/modbus.hpp"

namespace cusp::vfd {

enum class Protocol : std::uint8_t { kNone, kHuanyang, kHuanyangP2A, kPlain };
enum class Turning : std::uint8_t { kOff, kClockwise, kCounterClockwise };

// The registers of a plain drive, the words that it takes, and its scales: a speed is sent as
// rpm x to_multiplier / to_divisor and read as word x from_multiplier / from_divisor. Divisors are not 0.
struct PlainDrive {
    std::uint16_t run_register{0x2000};
    std::uint16_t speed_register{0x2001};
    std::uint16_t read_register{0x2103};
    std::uint16_t clockwise{18};
    std::uint16_t counter_clockwise{34};
    std::uint16_t stop{1};
    float to_multiplier{50};
    float to_divisor{60};
    float from_multiplier{60};
    float from_divisor{100};
};

struct VfdSetup {
    Protocol protocol{Protocol::kNone};
    std::uint8_t address{1};
    PlainDrive plain;
};

// The value that a message asks for. kScale: the speed at 50 Hz of a Huanyang, the greatest of a P2A, rpm; a plain
// drive has none.
enum class Query : std::uint8_t { kScale, kRun, kSpeed, kRead };
constexpr bool has_scale(Protocol protocol) noexcept { return protocol != Protocol::kPlain; }

Message scale_message(const VfdSetup& setup) noexcept;
Message run_message(const VfdSetup& setup, Turning turning) noexcept;
Message speed_message(const VfdSetup& setup, std::uint16_t word) noexcept;
Message read_message(const VfdSetup& setup) noexcept;

// A speed as the drive takes it, at most 65535, and back, rpm. scale: > 0.
std::uint16_t speed_word(const VfdSetup& setup, float rpm, float scale) noexcept;
float speed_of(const VfdSetup& setup, std::uint16_t word, float scale) noexcept;

// Bytes of the answer.
std::size_t answer_size(Protocol protocol, Query query) noexcept;

enum class AnswerKind : std::uint8_t { kGood, kRefused, kGarbled };
struct Answer {
    AnswerKind kind;
    std::uint16_t value;  // of kScale and kRead
};
// The meaning of `bytes` as an answer to `message`.
Answer parse_answer(Protocol protocol,
                    Query query,
                    const Message& message,
                    Span<const std::uint8_t> bytes) noexcept;
// Bytes of a refusal: an answer may be that short.
inline constexpr std::size_t kRefusalSize = 5;

}  // namespace cusp::vfd
