// Decimal numbers as a program writes them, and lengths kept finer than a nanometre.
//
// 6 decimals in millimetres and 5 in inches are whole nanometres (0.00001 in = 254 nm). Further
// digits are carried in millionths of a nanometre, so that only the accumulated position is
// rounded, never each move.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "firmware/base/result.hpp"
#include "firmware/base/vec.hpp"

namespace cusp::gcode {

// digits / 10^fraction_digits. |digits| < 10^18, fraction_digits <= 18.
struct Decimal {
    std::int64_t digits{0};
    std::uint8_t fraction_digits{0};

    constexpr bool is_negative() const noexcept { return digits < 0; }
    constexpr bool is_zero() const noexcept { return digits == 0; }
};

// Reads a number at text[place] and moves place past it. A sign, digits with at most one point;
// never an exponent: `1e3` is the number 1 and then the letter e, as in Grbl.
//
// Digits after the 17th are rounded away.
// Errors: kBadNumberFormat: no digit; kGcodeMaxValueExceeded: more than 12 digits before the point.
Result<Decimal> read_decimal(std::string_view text, std::size_t& place) noexcept;

// The nearest double.
double to_double(Decimal decimal) noexcept;

// True if it is a whole number from 0 to `maximum`.
bool is_whole(Decimal decimal, std::int64_t maximum) noexcept;

// The number without its decimals, towards 0.
std::int64_t whole_part(Decimal decimal) noexcept;

// nm + millionths / 10^6 nanometres; 0 <= millionths < 10^6.
struct ExactLength {
    std::int64_t nm{0};
    std::int32_t millionths{0};

    // To the nearest nanometre, halves upwards.
    constexpr std::int64_t rounded() const noexcept { return nm + (millionths >= 500000 ? 1 : 0); }

    friend constexpr ExactLength operator+(ExactLength a, ExactLength b) noexcept
    {
        constexpr std::int32_t kOne = 1000000;
        const std::int32_t sum = a.millionths + b.millionths;
        const bool carry = sum >= kOne;
        return {a.nm + b.nm + (carry ? 1 : 0), carry ? sum - kOne : sum};
    }
};

// Machine coordinates of the program, finer than the machine's own grid.
struct ExactPosition : AxisVec<ExactLength> {
    constexpr Position rounded() const noexcept
    {
        return mapped(*this, [](const ExactLength& length) { return length.rounded(); });
    }
};

constexpr ExactPosition to_exact(Position p) noexcept
{
    return {mapped(p, [](std::int64_t nm) { return ExactLength{nm, 0}; })};
}

// Nothing the controller handles is farther from machine zero than this: 100 m.
inline constexpr std::int64_t kMaxCoordinateNm = 100'000'000'000;

// A length word in millimetres or inches, exact to 12 (mm) or 11 (inch) decimals.
// Errors: kGcodeMaxValueExceeded: beyond kMaxCoordinateNm.
Result<ExactLength> to_length(Decimal decimal, bool inches) noexcept;

}  // namespace cusp::gcode
