// Margins for whole nanometres.
#include "firmware/planner/rounding_margin.hpp"

#include <algorithm>

#include "firmware/base/axis.hpp"

namespace cusp::planner {
namespace {

// Keeps rounding of set points and of the law in float below the limits.
constexpr float kRoundingMargin = 0.001F;
// Path units are sixteenths of a nanometre: differences of the set points before their own rounding
// are off by so much, and by no more than this part of small limits.
constexpr float kRoughAcceleration = 0.1F;  // mm/s^2
constexpr float kRoughestShare = 0.05F;

}  // namespace

MachineLimits with_margin(const MachineLimits& limits) noexcept
{
    constexpr float kFactor = 1.0F - kRoundingMargin;
    MachineLimits kept = limits;
    kept.velocity = limits.velocity * kFactor;
    kept.acceleration = limits.acceleration * kFactor;
    kept.jerk = limits.jerk * kFactor;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        kept.acceleration[i] -= std::min(kRoughAcceleration, kRoughestShare * kept.acceleration[i]);
    }
    return kept;
}

}  // namespace cusp::planner
