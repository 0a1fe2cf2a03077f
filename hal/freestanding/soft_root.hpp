// The square root and floor of a double with integers alone: correctly rounded on every machine.
#pragma once

#include <cstdint>

namespace cusp::hal {

// The square root of a double given by its bits, rounded to nearest, ties to even, as in IEEE 754.
// Negative numbers and NaN give NaN; zeros and infinity give themselves. Accuracy: equal to the
// host's std::sqrt in every bit (soft_root_test). Cost: 54 rounds.
constexpr std::uint64_t square_root_bits(std::uint64_t bits) noexcept
{
    constexpr std::uint64_t kInfinity = 0x7FF0000000000000U;
    constexpr std::uint64_t kNotANumber = 0x7FF8000000000000U;
    constexpr std::uint64_t kSign = 0x8000000000000000U;
    constexpr std::uint64_t kHidden = 0x0010000000000000U;
    if ((bits & ~kSign) == 0 || bits == kInfinity) {
        return bits;
    }
    if (bits > kInfinity) {
        return kNotANumber;
    }
    auto exponent = static_cast<std::int32_t>(bits >> 52U);
    std::uint64_t fraction = bits & (kHidden - 1);
    if (exponent == 0) {
        ++exponent;
        while ((fraction & kHidden) == 0) {
            fraction <<= 1U;
            --exponent;
        }
    } else {
        fraction |= kHidden;
    }
    exponent -= 1023;
    if (exponent % 2 != 0) {
        fraction <<= 1U;
        --exponent;
    }
    // fraction = m 2^52 with m in [1, 4). The root is found bit by bit, one bit beyond the 53 kept;
    // the remainder says whether anything is left below it.
    std::uint64_t root = 0;
    std::uint64_t doubled = 0;
    std::uint64_t remainder = fraction << 1U;
    for (std::uint64_t bit = kHidden << 1U; bit != 0; bit >>= 1U) {
        const std::uint64_t trial = doubled + bit;
        if (trial <= remainder) {
            doubled = trial + bit;
            remainder -= trial;
            root += bit;
        }
        remainder <<= 1U;
    }
    // A root of 54 bits is never exactly half way: its square would need 107 bits.
    root += root & 1U;
    const auto half = static_cast<std::uint64_t>(exponent / 2 + 1022);
    return (half << 52U) + (root >> 1U);
}

// The largest whole number not above a double given by its bits.
constexpr std::uint64_t floor_bits(std::uint64_t bits) noexcept
{
    constexpr std::uint64_t kMinusOne = 0xBFF0000000000000U;
    const auto exponent = static_cast<std::int32_t>(bits >> 52U & 0x7FFU) - 1023;
    const bool negative = (bits >> 63U) != 0;
    if (exponent >= 52 || bits << 1U == 0) {
        return bits;
    }
    if (exponent < 0) {
        return negative ? kMinusOne : 0;
    }
    const std::uint64_t below_the_point = 0x000FFFFFFFFFFFFFU >> static_cast<unsigned>(exponent);
    if ((bits & below_the_point) == 0) {
        return bits;
    }
    return (negative ? bits + below_the_point : bits) & ~below_the_point;
}

}  // namespace cusp::hal
