// Line numbers and checksums.
#include "firmware/protocol/checked_lines.hpp"

namespace cusp::protocol {

void CheckedLines::switch_on() noexcept
{
    on_.store(true, std::memory_order_relaxed);
    expected_ = 1;
    filter_.text();
}

std::optional<std::string_view> CheckedLines::accept(const LineAssembler& line) noexcept
{
    const std::string_view text = line.checked_part();
    if (!line.check().good || line.checked_part_overflow() || text.size() < 2 || text[0] != 'N') {
        return std::nullopt;
    }
    constexpr std::size_t kMostDigits = 9;
    std::uint32_t number = 0;
    std::size_t end = 1;
    while (end < text.size() && end <= kMostDigits && text[end] >= '0' && text[end] <= '9') {
        number = number * 10U + static_cast<std::uint32_t>(text[end] - '0');
        ++end;
    }
    const bool too_long = end < text.size() && text[end] >= '0' && text[end] <= '9';
    if (end == 1 || too_long || number != expected_) {
        return std::nullopt;
    }
    ++expected_;
    return text.substr(end);
}

bool RealtimeFilter::accept(std::uint8_t byte) noexcept
{
    if (byte == '?') {
        return true;
    }
    repetitions_ = byte == last_ ? static_cast<std::uint8_t>(repetitions_ + 1) : std::uint8_t{1};
    last_ = byte;
    if (repetitions_ < kRepetitions) {
        return false;
    }
    repetitions_ = 0;
    return true;
}

}  // namespace cusp::protocol
