// Sums over the sampled points of a part.
#include "host_tools/job/part_info/ground.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::part_info {
namespace {

constexpr double kFront = 0.01;  // mm: distance in front of a point at which visibility is tested
constexpr double kBase = 1e-3;   // mm: height of the underside above the lowest point

}  // namespace

double steepness(const GroundPlace& place)
{
    const double across = elementary::hypot(place.normal.x, place.normal.y);
    return elementary::atan2(across, std::abs(place.normal.z)) * 180 / kPi;
}

bool hidden_from_above(const TopOfPart& top, const GroundPlace& place)
{
    if (place.below) {
        return true;
    }
    const auto open_towards = [&](Vec3d normal) {
        const Vec3d front = place.point + normal * kFront;
        const auto height = top(front.x, front.y);
        return !height || *height < place.point.z + kFront;
    };
    return !open_towards(place.normal) && !(place.two_sided && open_towards(place.normal * -1.0));
}

Ground ground_of(const std::vector<GroundPlace>& places,
                 const std::vector<char>& hidden,
                 double lowest)
{
    Ground ground;
    double largest_hidden = 0;
    ground.steepest = -1;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const GroundPlace& place = places[k];
        const double degrees = steepness(place);
        ground.area += place.area;
        const bool underside =
            place.below && degrees < kLevelDegrees && place.point.z < lowest + kBase;
        if (hidden[k] != 0) {
            ground.hidden_area += underside ? 0 : place.area;
            if (!underside && place.area > largest_hidden) {
                largest_hidden = place.area;
                ground.hidden_at = place.point;
            }
            continue;
        }
        if (!(place.area > 0)) {
            continue;
        }
        if (degrees > ground.steepest) {
            ground.steepest = degrees;
            ground.steepest_at = place.point;
        }
        if (degrees > kVerticalDegrees) {
            ground.vertical_area += place.area;
        } else if (degrees > ground.steepest_slope.value_or(-1)) {
            ground.steepest_slope = degrees;
            ground.steepest_slope_at = place.point;
        }
        if (degrees < kLevelDegrees) {
            ground.level_area += place.area;
            if (!ground.level_at || place.point.z > ground.level_at->z) {
                ground.level_at = place.point;
            }
        }
    }
    ground.steepest = std::max(0.0, ground.steepest);
    return ground;
}

}  // namespace cusp::part_info
