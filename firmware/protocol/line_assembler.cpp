// The filter that Grbl applies to each byte of a line, and the check at its end.
#include "firmware/protocol/line_assembler.hpp"

#include "firmware/protocol/receive_queue.hpp"

namespace cusp::protocol {
namespace {

constexpr std::uint8_t kHexadecimalDigits = 8;

// The value of a hexadecimal digit, or 16 where it is none.
std::uint32_t digit_value(std::uint8_t byte) noexcept
{
    if (byte >= '0' && byte <= '9') {
        return std::uint32_t{byte} - '0';
    }
    if (byte >= 'A' && byte <= 'F') {
        return std::uint32_t{byte} - 'A' + 10U;
    }
    if (byte >= 'a' && byte <= 'f') {
        return std::uint32_t{byte} - 'a' + 10U;
    }
    return 16;
}

}  // namespace

bool LineAssembler::add(std::uint8_t byte) noexcept
{
    if (is_line_end(byte)) {
        return true;
    }
    started_ = true;
    add_check(byte);
    add_text(byte);
    return false;
}

LineCheck LineAssembler::check() const noexcept
{
    const bool present = star_ && digits_good_ && digits_ == kHexadecimalDigits;
    return {present, present && digits_value_ == crc_at_star_};
}

void LineAssembler::begin_line() noexcept
{
    length_ = 0;
    length_at_star_ = 0;
    overflow_at_star_ = false;
    crc_ = Crc32{};
    star_ = false;
    digits_ = 0;
    comment_ = Comment::kNone;
    overflow_ = false;
    started_ = false;
}

void LineAssembler::add_check(std::uint8_t byte) noexcept
{
    if (byte == '*') {
        star_ = true;
        crc_at_star_ = crc_.value();
        length_at_star_ = length_;
        overflow_at_star_ = overflow_;
        digits_ = 0;
        digits_value_ = 0;
        digits_good_ = true;
    } else if (star_) {
        const std::uint32_t value = digit_value(byte);
        digits_good_ = digits_good_ && value < 16 && digits_ < kHexadecimalDigits;
        if (digits_good_) {
            digits_value_ = digits_value_ << 4U | value;
            ++digits_;
        }
    }
    crc_.add(byte);
}

void LineAssembler::add_text(std::uint8_t byte) noexcept
{
    if (comment_ != Comment::kNone) {
        if (byte == ')' && comment_ == Comment::kParentheses) {
            comment_ = Comment::kNone;
        }
        return;
    }
    if (byte <= ' ' || byte == '/' || overflow_) {
        return;
    }
    if (byte == '(') {
        comment_ = Comment::kParentheses;
    } else if (byte == ';') {
        comment_ = Comment::kToEnd;
    } else if (length_ == kMaxLineLength) {
        overflow_ = true;
    } else {
        const bool lower = byte >= 'a' && byte <= 'z';
        text_[length_] = static_cast<char>(lower ? byte - 'a' + 'A' : byte);
        ++length_;
    }
}

}  // namespace cusp::protocol
