// Outlines bound what is hidden: between them all or nothing is.
#include "host_tools/surface_passes/hidden_places.hpp"

#include <algorithm>

#include "host_tools/surface_passes/place_coverage.hpp"

namespace cusp::host {
namespace {

constexpr double kNeedle = 0.01;  // mm, radius

}  // namespace

HiddenPlaces::HiddenPlaces(const std::vector<Surface>& surfaces,
                           const CertifiedPasses& certified,
                           double pitch)
    : certified_{certified}, tops_{surfaces, certified.model(), pitch}
{
}

// The squares around one that lies on a slope are higher than it.
double HiddenPlaces::roof_over(double z) const { return z + kHidden + 2 * tops_.pitch(); }

bool HiddenPlaces::under_others(Vec3d place) const
{
    return tops_.least_around(place.x, place.y) > roof_over(place.z);
}

bool HiddenPlaces::under_itself(Vec3d place, int surface) const
{
    return tops_.finds_over(place, kHidden, surface);
}

bool HiddenPlaces::hidden(Vec3d place, Vec3d normal) const
{
    const Vec2d at{place.x, place.y};
    if (!under_others(place)) {
        return tops_.finds_over(place, kHidden);
    }
    if (!(tops_.highest_outline(at, at) > roof_over(place.z))) {
        return true;
    }
    // The needle's shank meets what lies over the place.
    const Tool needle{0, ToolShape::kBall, kNeedle, kNeedle};
    const double rise = kHidden + kNeedle * (1 / std::max(normal.z, kUprightNormal) - 1);
    return !certified_.model().keeps_clear(needle, place + Vec3d{0, 0, rise}, 0.0);
}

bool HiddenPlaces::outlined_above(const std::array<Vec3d, 4>& corners) const
{
    Vec3d low = corners[0];
    Vec3d high = corners[0];
    for (const Vec3d& p : corners) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return tops_.highest_outline({low.x, low.y}, {high.x, high.y}) > roof_over(low.z);
}

}  // namespace cusp::host
