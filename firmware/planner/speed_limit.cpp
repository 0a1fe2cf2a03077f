// From bounds of the derivatives to bounds of speed and acceleration along the path.
#include "firmware/planner/speed_limit.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::planner {
namespace {

constexpr float kTiny = 1e-20F;

Vec3f larger(Vec3f a, Vec3f b) noexcept
{
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

// Largest v with k v^3 <= j, by bisection on the exponent-free form: v = (j/k)^(1/3).
float cube_root(float q) noexcept
{
    // Newton from above on v^3 = q converges from a start with v^3 >= q; q in [1e-12, 1e18].
    float v = std::max(1.0F, q);
    v = std::min(v, std::sqrt(q) + 1.0F);
    for (int i = 0; i < 24; ++i) {
        const float next = (2.0F * v + q / (v * v)) / 3.0F;
        if (next >= v) {
            break;
        }
        v = next;
    }
    return v;
}

}  // namespace

PathDerivatives larger(const PathDerivatives& a, const PathDerivatives& b) noexcept
{
    return {larger(a.first, b.first), larger(a.second, b.second), larger(a.third, b.third)};
}

SpeedLimit stricter(const SpeedLimit& a, const SpeedLimit& b) noexcept
{
    return {std::min(a.cap, b.cap), std::min(a.u0, b.u0), std::min(a.u1, b.u1),
            std::min(a.feed, b.feed)};
}

SpeedLimit speed_limit(const PathDerivatives& derivatives,
                       const MachineLimits& limits,
                       float jerk_share,
                       float filter_s,
                       float max_centripetal,
                       float max_speed) noexcept
{
    float cap = max_speed * max_speed;
    float jerk_speed = kUnlimited;
    for (unsigned i = 0; i < 3; ++i) {
        const float ratio = limits.velocity[i] / std::max(derivatives.first[i], kTiny);
        cap = std::min(cap, ratio < 1e12F ? ratio * ratio : kUnlimited);
        const float second = std::max(derivatives.second[i], kTiny);
        cap = std::min(cap, kCentripetalShare * limits.acceleration[i] / second);
        const float third = std::max(derivatives.third[i], kTiny);
        const float cube = kCurvatureJerkShare * jerk_share * limits.jerk[i] / third;
        if (cube < 1e15F) {
            jerk_speed = std::min(jerk_speed, cube_root(cube));
        }
    }
    if (jerk_speed < 1e6F) {
        cap = std::min(cap, jerk_speed * jerk_speed);
    }
    const float curvature = norm(derivatives.second);
    cap = std::min(cap, max_centripetal / std::max(curvature, kTiny));

    const float speed = std::sqrt(cap);
    SpeedLimit limit{cap, kUnlimited, kUnlimited, kUnlimited};
    for (unsigned i = 0; i < 3; ++i) {
        const float first = std::max(derivatives.first[i], kTiny);
        const float second = derivatives.second[i];
        const float jerk_left = jerk_share * limits.jerk[i] - derivatives.third[i] * speed * cap;
        const float by_jerk = jerk_left / (first / filter_s + 3.0F * second * speed);
        limit.u0 = std::min({limit.u0, limits.acceleration[i] / first, by_jerk});
        const float left = limits.acceleration[i] - second * cap;
        limit.u1 = std::min({limit.u1, left / first, by_jerk});
    }
    return limit;
}

}  // namespace cusp::planner
