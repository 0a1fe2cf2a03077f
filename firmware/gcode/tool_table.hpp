// ToolTable: the lengths of sixteen tools, by their T numbers. Plain data; the machine stores it.
#pragma once

#include <array>
#include <cstdint>

namespace cusp::gcode {

class ToolTable {
public:
    static constexpr unsigned kTools = 16;
    // 2 m: a length with its sign fits in 32 bits.
    static constexpr std::int64_t kMostLengthNm = 2'000'000'000;

    static constexpr bool holds(unsigned tool) noexcept { return tool >= 1 && tool <= kTools; }

    // True if no tool was entered: then every length is 0.
    constexpr bool empty() const noexcept { return entered_ == 0; }
    // Precondition of these three: holds(tool).
    constexpr bool has(unsigned tool) const noexcept
    {
        return (unsigned{entered_} >> (tool - 1) & 1U) != 0;
    }
    // 0 for a tool that was not entered.
    constexpr std::int64_t length_nm(unsigned tool) const noexcept { return lengths_[tool - 1]; }
    // Precondition: at most kMostLengthNm, either way.
    constexpr void enter(unsigned tool, std::int64_t length_nm) noexcept
    {
        lengths_[tool - 1] = static_cast<std::int32_t>(length_nm);
        entered_ = static_cast<std::uint16_t>(entered_ | 1U << (tool - 1));
    }

private:
    std::array<std::int32_t, kTools> lengths_{};  // nanometres along Z
    std::uint16_t entered_{0};                    // one bit a tool, T1 in bit 0
};

// True if a length fits into the table.
constexpr bool fits_tool_table(std::int64_t length_nm) noexcept
{
    return length_nm <= ToolTable::kMostLengthNm && length_nm >= -ToolTable::kMostLengthNm;
}

}  // namespace cusp::gcode
