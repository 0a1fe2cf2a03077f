// The least of four bounds.
#include "firmware/planner/speed_limit.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"

namespace cusp::planner {
namespace {

constexpr float kTiny = 1e-20F;
constexpr float kCentripetalShare = 0.92F;
constexpr float kCurvatureJerkShare = 0.5F;
constexpr float kGreatestCube = 1e15F;

}  // namespace

PathDerivatives larger(const PathDerivatives& a, const PathDerivatives& b) noexcept
{
    return to_vec(larger(to_lanes(a), to_lanes(b)));
}

float squared_cap(const LaneDerivatives& derivatives,
                  const MachineLimits& limits,
                  float max_centripetal,
                  float max_speed) noexcept
{
    const auto& [first, second, third] = derivatives;
    const LaneVec tiny = all_lanes(kTiny);
    const LaneVec ratio = quotient(to_lanes(limits.velocity), larger(first, tiny));
    float cap = least(max_speed * max_speed, product(ratio, ratio));
    cap = least(cap,
                quotient(to_lanes(limits.acceleration) * kCentripetalShare, larger(second, tiny)));
    cap = std::min(cap, max_centripetal / std::max(norm(second), kTiny));
    const float cube = least(
        kGreatestCube, quotient(to_lanes(limits.jerk) * kCurvatureJerkShare, larger(third, tiny)));
    const float root = cube_root(cube);
    return std::min(cap, root * root);
}

}  // namespace cusp::planner
