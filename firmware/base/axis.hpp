// The axes of the machine, and things there is one of per axis.
#pragma once

#include <array>
#include <cstdint>

namespace cusp {

enum class Axis : std::uint8_t { kX, kY, kZ };

inline constexpr unsigned kAxisCount = 3;

// Indexed by axis number, X first.
template <class T>
using PerAxis = std::array<T, kAxisCount>;

// A set of axes: one bit each, X in bit 0.
struct AxisMask {
    std::uint8_t bits{0};

    constexpr bool contains(unsigned axis) const noexcept
    {
        return (unsigned{bits} >> axis & 1U) != 0;
    }
    constexpr bool empty() const noexcept { return bits == 0; }
};

}  // namespace cusp
