// Interval arithmetic: every result encloses all results of numbers in the operands.
#pragma once

#include <algorithm>

namespace cusp::part_model {

struct Enclosure {
    double low;
    double high;
};

inline Enclosure operator+(Enclosure a, Enclosure b) { return {a.low + b.low, a.high + b.high}; }

inline Enclosure operator-(Enclosure a, Enclosure b) { return {a.low - b.high, a.high - b.low}; }

inline Enclosure operator*(Enclosure a, Enclosure b)
{
    const auto [low, high] =
        std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
    return {low, high};
}

inline Enclosure operator*(double k, Enclosure a) { return Enclosure{k, k} * a; }

// Precondition: b > 0.
inline Enclosure operator/(Enclosure a, Enclosure b)
{
    return {std::min(a.low / b.low, a.low / b.high), std::max(a.high / b.low, a.high / b.high)};
}

// Precondition: 0 is not in the interval.
inline Enclosure inverse(Enclosure a) { return {1.0 / a.high, 1.0 / a.low}; }

inline double magnitude(Enclosure a) { return std::max(-a.low, a.high); }

}  // namespace cusp::part_model
