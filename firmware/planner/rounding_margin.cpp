// Margins for whole nanometres and for places in float.
#include "firmware/planner/rounding_margin.hpp"

#include <algorithm>

#include "firmware/base/axis.hpp"

namespace cusp::planner {
namespace {

// Keeps rounding of set points and speeds below the limits; and, of one tick's braking, what
// PathServo may brake harder near a stop where the slopes of neighbouring intervals differ.
constexpr float kRoundingMargin = 0.0004F;
constexpr float kTickMargin = 0.006F;
// Path units are sixteenths of a nanometre: differences of the set points before their own rounding
// are off by so much, and by no more than this part of small limits.
constexpr float kRoughAcceleration = 0.1F;  // mm/s^2
constexpr float kRoughestShare = 0.05F;
// nm, of second and third differences of places on curves before the filters. A place is off by 4 at
// most (position_at()), which a second difference has four times. Its root mean square is 0.15: third
// differences behind a filter have 8^(1/2) times that, and five times this is left.
constexpr float kRoughCurveSecond = 16.0F;
constexpr float kRoughCurveThird = 2.0F;

}  // namespace

MachineLimits with_margin(const MachineLimits& limits, std::uint32_t path_filter) noexcept
{
    const float factor = 1.0F - kRoundingMargin - kTickMargin / static_cast<float>(path_filter);
    MachineLimits kept{limits.velocity * factor, limits.acceleration * factor,
                       limits.jerk * factor};
    for (unsigned i = 0; i < kAxisCount; ++i) {
        kept.acceleration[i] -= std::min(kRoughAcceleration, kRoughestShare * kept.acceleration[i]);
    }
    return kept;
}

// A nanometre a tick per tick is 1 mm/s2, and 1000 mm/s3 for another one.
void leave_to_rounding(MachineLimits& limits, AxisFilter filter) noexcept
{
    const auto ticks = static_cast<float>(filter.first * filter.second);
    for (unsigned i = 0; i < kAxisCount; ++i) {
        const float of_jerk = kRoughestShare * limits.jerk[i];
        const float of_acceleration = kRoughestShare * limits.acceleration[i];
        limits.jerk[i] -= std::min(1e3F * kRoughCurveThird / ticks, of_jerk);
        limits.acceleration[i] -= std::min(kRoughCurveSecond / ticks, of_acceleration);
    }
}

}  // namespace cusp::planner
