// Silhouettes bound hidden areas: between silhouettes either all points are hidden or none.
#include "host_tools/cam/finishing/visibility_from_above.hpp"

#include <algorithm>

#include "host_tools/cam/finishing/scallop_at_point.hpp"

namespace cusp::finishing {

using nurbs::Surface;
using toolpath::Tool;
using toolpath::ToolShape;

namespace {

constexpr double kNeedle = 0.01;          // mm, radius
constexpr double kSteepestNeedle = 1e-3;  // z of a normal: its needle starts 10 mm higher

}  // namespace

VisibilityFromAbove::VisibilityFromAbove(const std::vector<Surface>& surfaces,
                                         const GougeFreePathFitter& path_fitter,
                                         double pitch)
    : path_fitter_{path_fitter}, tops_{surfaces, path_fitter.model(), pitch}
{
}

// On a slope the neighbouring squares of a point's own surface are higher than the point.
double VisibilityFromAbove::hiding_height(double z) const
{
    return z + kHidden + 2 * tops_.pitch();
}

bool VisibilityFromAbove::may_be_under_others(Vec3d place) const
{
    return tops_.least_around(place.x, place.y) > hiding_height(place.z);
}

bool VisibilityFromAbove::under_others(Vec3d place) const
{
    // The map alone takes the bottom of a steep groove for covered.
    return may_be_under_others(place) && tops_.finds_over(place, kHidden);
}

bool VisibilityFromAbove::under_itself(Vec3d place, int surface) const
{
    return tops_.finds_over(place, kHidden, surface);
}

bool VisibilityFromAbove::is_hidden(Vec3d place, Vec3d normal) const
{
    if (tops_.finds_over(place, kHidden)) {
        return true;
    }
    if (!may_be_under_others(place)) {
        return false;
    }
    // A needle touches any surface over the point with its shank.
    const Tool needle{0, ToolShape::kBall, kNeedle, kNeedle};
    const double rise = kHidden + kNeedle * (1 / std::max(normal.z, kSteepestNeedle) - 1);
    return !path_fitter_.model().is_distance_at_least(needle, place + Vec3d{0, 0, rise}, 0.0);
}

bool VisibilityFromAbove::silhouette_above(const std::array<Vec3d, 4>& corners) const
{
    Vec3d low = corners[0];
    Vec3d high = corners[0];
    for (const Vec3d& p : corners) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return tops_.highest_silhouette({low.x, low.y}, {high.x, high.y}) > hiding_height(low.z);
}

}  // namespace cusp::finishing
