// Capabilities of the axes: the types that planner, interpolator and settings share.
#pragma once

#include "firmware/base/vec.hpp"

namespace cusp {

// Per axis; all > 0. Validated where settings are set (machine/settings.hpp).
struct MachineLimits {
    Vec3f velocity{100.0F, 100.0F, 50.0F};         // mm/s
    Vec3f acceleration{1000.0F, 1000.0F, 500.0F};  // mm/s^2
    Vec3f jerk{50000.0F, 50000.0F, 25000.0F};      // mm/s^3
    friend constexpr bool operator==(const MachineLimits& a, const MachineLimits& b) noexcept
    {
        return a.velocity == b.velocity && a.acceleration == b.acceleration && a.jerk == b.jerk;
    }
};

}  // namespace cusp
