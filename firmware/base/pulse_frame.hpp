// PulseFrame: every edge of the step and direction lines in one servo tick; what a HAL plays.
#pragma once

#include <cstdint>

#include "firmware/base/axis.hpp"
#include "firmware/base/static_vector.hpp"

namespace cusp {

// A servo tick lasts 1 ms and is cut into pulse ticks of 1 us, on every board and in the simulator.
inline constexpr std::uint32_t kPulseTicksPerFrame = 1000;
inline constexpr std::uint32_t kServoTicksPerSecond = 1000;

// The lines of a frame, one bit each: steps of X Y Z in bits 0 to 2, directions in bits 3 to 5; step and
// direction of the fourth motor in bits 6 and 7: that of A, or the second one of an axis (setting 793).
// Logical levels: a step is a rising edge, direction 1 moves towards plus. Boards invert at the
// pin.
using PulseLines = std::uint8_t;

inline constexpr PulseLines kSecondStepLine = 1U << 6U;
inline constexpr PulseLines kSecondDirectionLine = 1U << 7U;

constexpr PulseLines step_line(unsigned axis) noexcept
{
    return axis < kLinearAxes ? static_cast<PulseLines>(1U << axis) : kSecondStepLine;
}
constexpr PulseLines direction_line(unsigned axis) noexcept
{
    return axis < kLinearAxes ? static_cast<PulseLines>(8U << axis) : kSecondDirectionLine;
}

inline constexpr PulseLines kStepLines = 7U | kSecondStepLine;

// All changes of one pulse tick. No line is in both.
struct PulseEdge {
    std::uint16_t tick;  // < kPulseTicksPerFrame; strictly rising within a frame
    PulseLines raise;
    PulseLines lower;
};

struct PulseFrame {
    StaticVector<PulseEdge, kPulseTicksPerFrame> edges;
};

}  // namespace cusp
