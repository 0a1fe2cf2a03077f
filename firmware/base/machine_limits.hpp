// Capabilities of the axes: the types that planner, interpolator and settings share.
#pragma once

#include <type_traits>

#include "firmware/base/vec.hpp"

namespace cusp {

// Which axes a machine has: in a build with the rotary axis it may still be without.
struct WithoutRotaryAxis {
    static constexpr bool has_rotary{false};
    void set_rotary(bool /*on*/) noexcept {}
};
struct MayHaveRotaryAxis {
    bool has_rotary{false};
    void set_rotary(bool on) noexcept { has_rotary = on; }
};

// Per axis; all > 0. Validated where settings are set (machine/settings.hpp).
struct MachineLimits : std::conditional_t<kHasRotaryAxis, MayHaveRotaryAxis, WithoutRotaryAxis> {
    AxisVecf velocity = as_x(100.0F, 100.0F, 50.0F);         // mm/s
    AxisVecf acceleration = as_x(1000.0F, 1000.0F, 500.0F);  // mm/s^2
    AxisVecf jerk = as_x(50000.0F, 50000.0F, 25000.0F);      // mm/s^3

    // An axis that the machine lacks never moves: with the limits of X it changes no bit of what is the least or
    // greatest of all.
    static constexpr AxisVecf as_x(float x, float y, float z) noexcept
    {
        AxisVecf limits{Vec3f{x, y, z}};
        for (unsigned axis = kLinearAxes; axis < kAxisCount; ++axis) {
            limits[axis] = x;
        }
        return limits;
    }

    // To be called once limits of X have changed.
    void settle_lacking_axis() noexcept
    {
        for (unsigned axis = kLinearAxes; axis < kAxisCount && !has_rotary; ++axis) {
            velocity[axis] = velocity[0];
            acceleration[axis] = acceleration[0];
            jerk[axis] = jerk[0];
        }
    }

    // Limits of all axes of the machine together.
    float whole_velocity() const noexcept { return whole(velocity); }
    float whole_acceleration() const noexcept { return whole(acceleration); }

    friend constexpr bool operator==(const MachineLimits& a, const MachineLimits& b) noexcept
    {
        return a.velocity == b.velocity && a.acceleration == b.acceleration && a.jerk == b.jerk &&
               a.has_rotary == b.has_rotary;
    }

private:
    float whole(const AxisVecf& v) const noexcept { return has_rotary ? norm(v) : norm(xyz(v)); }
};

}  // namespace cusp
