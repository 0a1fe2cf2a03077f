// The reach is the least of bounds by planes that the tool touches, each tilted about a line across the
// way. A ball's is the half chord.
#include "host_tools/geometry/part_model/tool_cap.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::part_model {

namespace {

constexpr double kLeastTilt = 1e-3;  // radians
constexpr double kGrowth = 1.3;      // of the tilts that are tried
constexpr double kFinest = 1e-3;     // of the best tilt

// How far the tool reaches in a direction that does not rise, from its core's end.
double support(const ToolProfile& tool, Vec3d direction)
{
    return dot(tool.core().farthest_against(-direction), direction) + tool.corner();
}

}  // namespace

double cap_reach(const ToolProfile& tool, Vec3d normal, Vec3d way, double height)
{
    const double corner = tool.corner();
    const ToolCore& core = tool.core();
    if (core.radius == 0 && corner > height) {
        const double half = std::sqrt(height * (2 * corner - height));
        // All of the chord is on the ball where it is below the flank or the shank.
        const double tilt = elementary::asin(std::min(1.0, elementary::hypot(normal.x, normal.y))) +
                            elementary::asin(half / corner);
        if (tilt + elementary::atan(core.widening) <= 0.5 * kPi) {
            return half;
        }
    }
    const double bottom = support(tool, -normal);
    const Vec3d contact = core.farthest_against(normal) - normal * corner;
    const auto bound = [&](double tilt) {
        const double along = elementary::sin(tilt);
        const double down = elementary::cos(tilt);
        const Vec3d direction = way * along - normal * down;
        return direction.z > 0 ? kInfinite
                               : (support(tool, direction) + down * (height - bottom)) / along;
    };
    double best = kInfinite;
    double at = kLeastTilt;
    for (double tilt = kLeastTilt; tilt < 0.5 * kPi * kGrowth; tilt *= kGrowth) {
        const double used = std::min(tilt, 0.5 * kPi);
        if (const double here = bound(used); here < best) {
            best = here;
            at = used;
        }
    }
    // Each bound is one: those beside the best one make it better.
    for (double aside = 0.5 * (kGrowth - 1); aside > kFinest; aside *= 0.5) {
        for (const double tilt : {at * (1 - aside), std::min(at * (1 + aside), 0.5 * kPi)}) {
            if (const double here = bound(tilt); here < best) {
                best = here;
                at = tilt;
            }
        }
    }
    return best - dot(contact, way);
}

}  // namespace cusp::part_model
