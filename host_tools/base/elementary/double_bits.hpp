// Sums and products of doubles without error, in two parts.
#pragma once

#include <cstdint>
#include <cstring>

namespace cusp::elementary {

struct Sum {
    double value;
    double error;  // value + error is the exact result
};

// Knuth's sum, for numbers of any size.
inline Sum sum_of(double a, double b)
{
    const double value = a + b;
    const double of_b = value - a;
    return {value, (a - (value - of_b)) + (b - of_b)};
}

// The upper 21 bits of the mantissa: squares are exact, and so are products of two such numbers.
inline double upper_half(double value)
{
    std::uint64_t bits{};
    static_assert(sizeof bits == sizeof value);
    std::memcpy(&bits, &value, sizeof bits);
    bits &= 0xffffffff00000000U;
    std::memcpy(&value, &bits, sizeof bits);
    return value;
}

}  // namespace cusp::elementary
