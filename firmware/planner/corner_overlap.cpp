// Finds how early a stretch may start while the one before drains.
#include "firmware/planner/corner_overlap.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::planner {
namespace {

// If both sides together would need this many times the jerk of one, slowing them down costs
// more than the overlap saves.
constexpr float kGreatestDemand = 1.9F;
constexpr std::uint32_t kFewestTicks = 3;
constexpr std::uint32_t kMostTicks = 60;
// Travel is a sum over ticks and ends on one.
constexpr float kZoneMargin = 1.2F;

// Greatest acceleration in a direction, mm/s^2.
float acceleration_along(Vec3f direction, const MachineLimits& limits) noexcept
{
    float most = limits.acceleration.x / std::max(std::fabs(direction.x), 1e-6F);
    most = std::min(most, limits.acceleration.y / std::max(std::fabs(direction.y), 1e-6F));
    return std::min(most, limits.acceleration.z / std::max(std::fabs(direction.z), 1e-6F));
}

// Jerk, of any axis, that the bend of a stretch adds while it is left or entered with u over time.
float bend_jerk(const CornerSide& side, float u, float time, float filter_s) noexcept
{
    const float speed = u * time;
    const float turn = side.bend * 0.5F * speed * time;
    return 3.0F * side.bend * speed * u + side.change * speed * speed * speed + turn * u / filter_s;
}

// The jerk of both sides together as a part of what the axes allow.
float demand(const CornerSide& before,
             const CornerSide& after,
             const CornerOverlap& overlap,
             const MachineLimits& limits,
             float time,
             float filter_s) noexcept
{
    const float bends = bend_jerk(before, overlap.braking, time, filter_s) +
                        bend_jerk(after, overlap.speeding, time, filter_s);
    float most = 0;
    for (unsigned i = 0; i < 3; ++i) {
        const float both =
            before.end.tangent[i] * overlap.braking + after.end.tangent[i] * overlap.speeding;
        most = std::max(most, (std::fabs(both) / filter_s + bends) / limits.jerk[i]);
    }
    return most;
}

}  // namespace

float mean_cube(float h, AxisFilter filter) noexcept
{
    const float first = static_cast<float>(filter.first) * kServoTick;
    const float second = static_cast<float>(filter.second) * kServoTick;
    const float beyond = std::max(0.0F, 0.5F * (first + second) - h);
    const float square = beyond * beyond;
    return h * h * h / 6.0F + h * (first * first + second * second) / 24.0F +
           square * square / (24.0F * first);
}

CornerSide corner_side(const Block& block, const EndGeometry& end, float length) noexcept
{
    const float curvature = norm(end.curvature);
    if (block.shape != BlockShape::kQuintic) {
        return {end, length, curvature, curvature * curvature};
    }
    PathDerivatives bounds{};
    for (unsigned i = 0; i < stretch_count(block); ++i) {
        bounds = larger(bounds, to_vec(stretch(block, i).derivatives));
    }
    return {end, length, norm(bounds.second), norm(bounds.third)};
}

CornerOverlap corner_overlap(const CornerSide& before,
                             const CornerSide& after,
                             const MachineLimits& limits,
                             std::uint32_t path_filter,
                             AxisFilter filter,
                             float deviation) noexcept
{
    const float filter_s = static_cast<float>(path_filter) * kServoTick;
    const CornerOverlap full{0, acceleration_along(before.end.tangent, limits),
                             acceleration_along(after.end.tangent, limits), 0, 0};
    for (std::uint32_t ticks = std::min(path_filter, kMostTicks); ticks >= kFewestTicks; --ticks) {
        const float time = static_cast<float>(ticks) * kServoTick;
        CornerOverlap overlap = full;
        const float excess = std::max(1.0F, demand(before, after, overlap, limits, time, filter_s));
        if (excess > kGreatestDemand) {
            continue;
        }
        overlap.ticks = static_cast<std::uint8_t>(ticks);
        overlap.braking /= excess;
        overlap.speeding /= excess;
        const float half = 0.5F * time;
        const Vec3f pull =
            after.end.tangent * overlap.speeding - before.end.tangent * overlap.braking;
        const float cut = norm(pull) / filter_s * mean_cube(half, filter);
        const float square = 0.5F * kZoneMargin * (time + kServoTick) * (time + kServoTick);
        overlap.before = overlap.braking * square;
        overlap.after = overlap.speeding * square;
        if (cut <= deviation && overlap.before <= before.length && overlap.after <= after.length) {
            return overlap;
        }
    }
    return {};
}

}  // namespace cusp::planner
