// The axes of the machine, and things there is one of per axis.
#pragma once

#include <array>
#include <cstdint>

namespace cusp {

enum class Axis : std::uint8_t { kX, kY, kZ, kA };

// X, Y and Z, which are lengths.
inline constexpr unsigned kLinearAxes = 3;

// With the rotary axis A, in degrees, 4: a constant of the build (CUSP_AXES of CMake).
inline constexpr unsigned kAxisCount = CUSP_AXES;
static_assert(kAxisCount == kLinearAxes || kAxisCount == kLinearAxes + 1);
inline constexpr bool kHasRotaryAxis = kAxisCount > kLinearAxes;

// Indexed by axis number, X first.
template <class T>
using PerAxis = std::array<T, kAxisCount>;

// The results of a function of the axis' number.
template <class F>
constexpr auto of_axes(F f) noexcept
{
    PerAxis<decltype(f(0U))> values{};
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        values[axis] = f(axis);
    }
    return values;
}

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
