// The unit of everything that moves once a tick: sixteenths of a nanometre, in 32-bit integers.
#pragma once

#include <cstdint>

#include "firmware/base/vec.hpp"

namespace cusp {

inline constexpr std::int32_t kPathUnitsPerNanometre = 16;
inline constexpr float kPathUnitsPerMillimetre = 16e6F;

// No block is longer: 64 mm are 1.02e9 path units, which an int32 holds.
inline constexpr double kMaxBlockLength = 64.0;

inline constexpr float kServoTick = 1e-3F;  // s

// Longest filter on the travel along the path, servo ticks: 250 ms.
inline constexpr std::uint32_t kMaxPathFilter = 250;

// A speed of 1 mm/s in path units a tick.
inline constexpr float kPathUnitsPerTick = kPathUnitsPerMillimetre * kServoTick;

// A displacement within a block, in path units.
using PathOffset = AxisVec<std::int32_t>;

}  // namespace cusp
