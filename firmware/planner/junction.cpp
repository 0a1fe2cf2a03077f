// Speeds at junctions, from what the axis filters make of a jump.
#include "firmware/planner/junction.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::planner {
namespace {

constexpr unsigned kBisections = 20;

struct Shares {
    float acceleration;
    float jerk;
};

float greater(const Shares& shares) noexcept { return std::max(shares.acceleration, shares.jerk); }

// Shares of the axes' acceleration and jerk left over by the curves that the junction takes at v,
// where the limits left are those at `fastest`.
Shares shares_at(const Junction& junction,
                 const MachineLimits& limits,
                 AxisFilter filter,
                 float v,
                 float fastest) noexcept
{
    const float first = static_cast<float>(filter.first) * kServoTick;
    const float second = static_cast<float>(filter.second) * kServoTick;
    const float square = v * v;
    const float fastest_square = fastest * fastest;
    const float fastest_cube = fastest_square * fastest;
    Shares shares{0, 0};
    for (unsigned i = 0; i < 3; ++i) {
        const float jump = v * junction.direction[i];
        // No stretch is passed faster than its own cap, which leaves a share of either limit.
        const float acceleration_left =
            std::max(limits.acceleration[i] - junction.second[i] * fastest_square,
                     (1.0F - kCentripetalShare) * limits.acceleration[i]);
        const float jerk_left = std::max(limits.jerk[i] - junction.third[i] * fastest_cube,
                                         (1.0F - kCurvatureJerkShare) * limits.jerk[i]);
        const float acceleration = jump / first;
        const float jerk =
            acceleration / second +
            (junction.curvature[i] * square + junction.direction[i] * limits.acceleration[i]) /
                first;
        shares.acceleration = std::max(shares.acceleration, acceleration / acceleration_left);
        shares.jerk = std::max(shares.jerk, jerk / jerk_left);
    }
    return shares;
}

// The jerk that jumps of direction make grows with the speed: as a line over the squared speed
// half of it counts at rest, and all of what does not depend on the speed.
JunctionShare junction_share_at(const Junction& junction,
                                const MachineLimits& limits,
                                AxisFilter filter,
                                float v) noexcept
{
    const Shares shares = shares_at(junction, limits, filter, v, v);
    Junction corner = junction;
    corner.curvature = {};
    const float moving = shares_at(corner, limits, filter, v, v).jerk;
    const float standing = shares_at(corner, limits, filter, 0.0F, v).jerk;
    return {v, shares.acceleration, std::min(0.5F * (moving + standing), shares.jerk), shares.jerk};
}

}  // namespace

Junction make_junction(const EndGeometry& before,
                       const EndGeometry& after,
                       const PathDerivatives& around) noexcept
{
    const Vec3f direction = after.tangent - before.tangent;
    return {magnitude(direction), magnitude(after.curvature - before.curvature), around.second,
            around.third, norm(direction)};
}

Junction combined(const Junction& a, const Junction& b) noexcept
{
    return {a.direction + b.direction, a.curvature + b.curvature, larger(a.second, b.second),
            larger(a.third, b.third), a.turn + b.turn};
}

JunctionShare junction_share(const Junction& junction,
                             const MachineLimits& limits,
                             AxisFilter filter,
                             float max_share,
                             float max_speed,
                             float deviation) noexcept
{
    // A corner turned by the filters leaves the vertex by v turn/2 times the mean of |t| under
    // their kernel: at most t1/4 + t2/12.
    const float mean_time =
        (static_cast<float>(filter.first) / 4.0F + static_cast<float>(filter.second) / 12.0F) *
        kServoTick;
    float fast = max_speed;
    if (junction.turn * fast * mean_time > 2.0F * deviation) {
        fast = 2.0F * deviation / (junction.turn * mean_time);
    }
    if (greater(shares_at(junction, limits, filter, fast, fast)) <= max_share) {
        return junction_share_at(junction, limits, filter, fast);
    }
    float slow = 0;
    for (unsigned i = 0; i < kBisections; ++i) {
        const float middle = 0.5F * (slow + fast);
        const Shares shares = shares_at(junction, limits, filter, middle, middle);
        (greater(shares) <= max_share ? slow : fast) = middle;
    }
    return junction_share_at(junction, limits, filter, slow);
}

}  // namespace cusp::planner
