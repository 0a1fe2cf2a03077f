// Numbers to text without the C library.
#include "firmware/protocol/reply_queue.hpp"

#include <algorithm>

namespace cusp::protocol {
namespace {

// number / divisor to the nearest, halves away from zero.
std::int64_t rounded_quotient(std::int64_t number, std::int64_t divisor) noexcept
{
    const std::int64_t half = divisor / 2;
    return (number < 0 ? number - half : number + half) / divisor;
}

}  // namespace

ReplyQueue& ReplyQueue::character(char character) noexcept
{
    CUSP_ASSERT(room() > 0);
    bytes_[head_ % kCapacity] = static_cast<std::uint8_t>(character);
    ++head_;
    return *this;
}

ReplyQueue& ReplyQueue::text(std::string_view text) noexcept
{
    for (const char c : text) {
        (void)character(c);
    }
    return *this;
}

ReplyQueue& ReplyQueue::number(std::uint32_t number) noexcept
{
    return decimal(static_cast<std::int64_t>(number), 0);
}

ReplyQueue& ReplyQueue::decimal(std::int64_t scaled, unsigned decimals) noexcept
{
    constexpr unsigned kMostDigits = 20;
    std::array<char, kMostDigits + 2> digits{};
    unsigned count = 0;
    std::uint64_t rest =
        scaled < 0 ? ~static_cast<std::uint64_t>(scaled) + 1U : static_cast<std::uint64_t>(scaled);
    const bool negative = scaled < 0;
    do {
        if (count == decimals && count > 0) {
            digits[count] = '.';
            ++count;
            // The point takes a place of its own; whole digits follow.
            decimals = kMostDigits + 1;
        }
        digits[count] = static_cast<char>('0' + rest % 10U);
        rest /= 10U;
        ++count;
    } while (rest != 0 || (decimals <= kMostDigits && count <= decimals));
    if (negative) {
        (void)character('-');
    }
    while (count > 0) {
        --count;
        (void)character(digits[count]);
    }
    return *this;
}

ReplyQueue& ReplyQueue::hexadecimal(std::uint32_t number) noexcept
{
    for (unsigned shift = 32; shift > 0;) {
        shift -= 4;
        (void)character("0123456789ABCDEF"[number >> shift & 15U]);
    }
    return *this;
}

Span<const std::uint8_t> ReplyQueue::pending() const noexcept
{
    const std::uint32_t start = tail_ % kCapacity;
    const std::uint32_t size = std::min(head_ - tail_, kCapacity - start);
    return {bytes_.data() + start, size};
}

void ReplyQueue::drop(std::uint32_t count) noexcept { tail_ += count; }

void write_length(ReplyQueue& out, std::int64_t nanometres, bool inches) noexcept
{
    constexpr std::int64_t kNanometresPerTenThousandthInch = 2540;
    constexpr std::int64_t kNanometresPerMicrometre = 1000;
    if (inches) {
        (void)out.decimal(rounded_quotient(nanometres, kNanometresPerTenThousandthInch), 4);
    } else {
        (void)out.decimal(rounded_quotient(nanometres, kNanometresPerMicrometre), 3);
    }
}

void write_position(ReplyQueue& out, Position position, PlaceForm form) noexcept
{
    for (unsigned axis = 0; axis < form.axes; ++axis) {
        if (axis > 0) {
            (void)out.character(',');
        }
        write_length(out, position[axis], form.inches && axis < kLinearAxes);
    }
}

std::int64_t scaled(float value, unsigned decimals) noexcept
{
    auto number = static_cast<double>(value);
    for (unsigned i = 0; i < decimals; ++i) {
        number *= 10.0;
    }
    return static_cast<std::int64_t>(number < 0 ? number - 0.5 : number + 0.5);
}

}  // namespace cusp::protocol
