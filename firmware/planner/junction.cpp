// Speeds at junctions, from the response of the axis filters to a jump.
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

// Combined effect of jumps of curvature at the speed v, 1/mm: the largest net change. If the
// speed has a minimum between them, its decrease is bounded by jerk along the path.
Vec3f counted_curvature(const JunctionRun& run,
                        const MachineLimits& limits,
                        AxisFilter filter,
                        float v) noexcept
{
    const float window = static_cast<float>(filter.first + filter.second) * kServoTick;
    const float dip = norm(limits.jerk) * window * window / (4.0F * std::max(v, 1e-6F));
    return smaller(run.total, run.greatest * (1.0F + std::min(dip, 1.0F)));
}

// Shares of the axes' acceleration and jerk left over by the curves that the junction takes at v,
// where the limits left are those at `fastest`.
Shares shares_at(const Junction& junction,
                 Vec3f curvature,
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
                                         (1.0F - kTransitionJerkShare) * limits.jerk[i]);
        const float acceleration = jump / first;
        const float jerk =
            acceleration / second +
            (curvature[i] * square + junction.direction[i] * limits.acceleration[i]) / first;
        shares.acceleration = std::max(shares.acceleration, acceleration / acceleration_left);
        shares.jerk = std::max(shares.jerk, jerk / jerk_left);
    }
    return shares;
}

// The share of the limits that a run takes at a speed.
struct Taken {
    Vec3f curvature;  // that counts
    Shares shares;
};

Taken taken_at(const JunctionRun& run,
               const MachineLimits& limits,
               AxisFilter filter,
               float v) noexcept
{
    const Vec3f curvature = counted_curvature(run, limits, filter, v);
    return {curvature, shares_at(run.all, curvature, limits, filter, v, v)};
}

// The jerk that jumps of direction make grows with the speed, and so does that of a dip of the speed
// between jumps of curvature: as a line over the squared speed half of it counts at rest, and all of what does not depend on the speed.
JunctionShare junction_share_at(const JunctionRun& run,
                                const MachineLimits& limits,
                                AxisFilter filter,
                                float v,
                                const Taken& taken) noexcept
{
    const Shares& shares = taken.shares;
    const Vec3f of_dip = taken.curvature - smaller(taken.curvature, run.greatest);
    const float moving = shares_at(run.all, of_dip, limits, filter, v, v).jerk;
    const float standing = shares_at(run.all, {}, limits, filter, 0.0F, v).jerk;
    return {v, shares.acceleration, std::min(0.5F * (moving + standing), shares.jerk), shares.jerk};
}

}  // namespace

Junction make_junction(const EndGeometry& before,
                       const EndGeometry& after,
                       const PathDerivatives& around) noexcept
{
    const Vec3f direction = after.tangent - before.tangent;
    return {magnitude(direction), after.curvature - before.curvature, around.second, around.third,
            norm(direction)};
}

void JunctionRun::add(const Junction& earlier) noexcept
{
    all.direction = all.direction + earlier.direction;
    all.second = larger(all.second, earlier.second);
    all.third = larger(all.third, earlier.third);
    all.turn += earlier.turn;
    net = net + earlier.curvature;
    greatest = larger(greatest, magnitude(net));
    total = total + magnitude(earlier.curvature);
}

JunctionShare junction_share(const JunctionRun& run,
                             const MachineLimits& limits,
                             AxisFilter filter,
                             float max_share,
                             float max_speed,
                             const Blur& blur) noexcept
{
    // A corner turned by the filters leaves the vertex by v turn/2 times the mean of |t| under
    // their kernel: at most t1/4 + t2/12.
    const float mean_time =
        (static_cast<float>(filter.first) / 4.0F + static_cast<float>(filter.second) / 12.0F) *
            kServoTick +
        blur.mean_time;
    float fast = max_speed;
    if (run.all.turn * fast * mean_time > 2.0F * blur.deviation) {
        fast = 2.0F * blur.deviation / (run.all.turn * mean_time);
    }
    if (blur.square > 0) {
        // Together with the bends around it: turn v mean_time/2 + bend v^2 square <= deviation.
        const float half = 0.25F * run.all.turn * mean_time;
        const float bend = norm(run.all.second) * blur.square;
        const float root = std::sqrt(half * half + bend * blur.deviation);
        fast = std::min(fast, blur.deviation / std::max(half + root, 1e-12F));
    }
    const Taken at_fast = taken_at(run, limits, filter, fast);
    if (greater(at_fast.shares) <= max_share) {
        return junction_share_at(run, limits, filter, fast, at_fast);
    }
    float slow = 0;
    for (unsigned i = 0; i < kBisections; ++i) {
        const float middle = 0.5F * (slow + fast);
        const Taken taken = taken_at(run, limits, filter, middle);
        (greater(taken.shares) <= max_share ? slow : fast) = middle;
    }
    return junction_share_at(run, limits, filter, slow, taken_at(run, limits, filter, slow));
}

}  // namespace cusp::planner
