// Input shaping: the motion of a vibrating axis comes in two parts half a period apart, so that the
// second part stops the vibration which the first has begun.
//
// Each axis names its vibration: a frequency, a damping ratio, and how sure of it one is. All axes
// get the product of what they name: with one kernel for all of them a straight line stays straight
// at any acceleration, which it would not if one axis lagged behind another.
//
//   zero vibration       two impulses, half a period: no vibration at the frequency.
//   ... and derivative   the same twice, a period: little of it within some 14 % too.
//   extra insensitive    two of them, one below, one above the frequency: at most 5 % of the
//                        vibration within 20 %.
//
// A shaper is a chain of stages, each of which removes one frequency. A stage has three taps, now,
// n and n + 1 ticks later: three weights that sum to one and make the complex sum of the vibration
// zero exist for any frequency on the grid of ticks, and none of them is negative.
//
// Source: Singer and Seering, "Preshaping command inputs to reduce system vibration", 1990; Singhose,
// Seering and Singer, "Residual vibration reduction using vector diagrams to generate shaped inputs",
// 1994. Derivation: docs/numerics.md, "Input shaping". Held by
// tests/unit/planner/input_shaper_test.cpp.
#pragma once

#include <cstdint>

#include "firmware/base/axis.hpp"
#include "firmware/base/static_vector.hpp"
#include "firmware/base/vec.hpp"

namespace cusp::planner {

enum class ShaperType : std::uint8_t {
    kNone,
    kZeroVibration,            // ZV
    kZeroVibrationDerivative,  // ZVD
    kExtraInsensitive,         // EI
};

// The vibration of an axis.
struct AxisVibration {
    ShaperType type{ShaperType::kNone};
    float frequency{0};  // Hz, damped or not: 10 to 200
    float damping{0};    // ratio, 0 to 0.9
    friend constexpr bool operator==(const AxisVibration& a, const AxisVibration& b) noexcept
    {
        return a.type == b.type && a.frequency == b.frequency && a.damping == b.damping;
    }
};

// Weights are whole and sum to 2^kShaperBits.
inline constexpr unsigned kShaperBits = 20;

struct ShaperStage {
    std::uint32_t ticks;  // n >= 1
    std::int32_t now;     // weight at once,
    std::int32_t later;   // n ticks later
    std::int32_t last;    // and n + 1
};

// All stages together are at most so long, servo ticks: what the interpolator has memory for.
inline constexpr std::uint32_t kMostShaperTicks = 128;
inline constexpr std::size_t kMostShaperStages = 2 * kLinearAxes;

// The shaper of a machine. Without stages it is off.
struct InputShaper {
    StaticVector<ShaperStage, kMostShaperStages> stages;
    std::uint32_t ticks{0};  // length of its response
    float length{0};         // the same, s
    float square{0};         // variance of its response, s^2
    float mean_time{0};      // its root, s: at least the mean of |t| about the centre
    float reach{0};          // s, from the centre to the farther end

    bool on() const noexcept { return !stages.empty(); }
};

// The shaper for all axes. Axes that name the same share one. Its length may be above
// kMostShaperTicks: then it is not to be used.
InputShaper make_input_shaper(const PerAxis<AxisVibration>& axes) noexcept;

}  // namespace cusp::planner
