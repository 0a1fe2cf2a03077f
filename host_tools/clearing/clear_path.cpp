// Steps as long as there is room, or so short that no corner reaches in between two places.
#include "host_tools/clearing/clear_path.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::clearing {

using offset::Edge;
using offset::RegionOffset;

namespace {

constexpr double kSlack = 1e-5;  // mm
constexpr double kHardly = 0.1;  // mm: less off the contours, places may lie on either side

// A corner is nearest abreast of the middle between two places h apart: by h^2 / (8 clearance)
// nearer than both on a straight way, on an arc by its height over the chord, h^2 / (8 radius),
// more.
double spacing(const Edge& way, double clearance)
{
    const double bend = way.turn == 0 ? 0.0 : 1.0 / way.radius;
    return std::sqrt(4.0 * kSlack / (1.0 / std::max(clearance, kHardly) + bend));
}

}  // namespace

bool is_path_clear(const RegionOffset& region, const Edge& way, double clearance)
{
    constexpr double kFar = 5.0;
    const double whole = length(way);
    const double shortest = spacing(way, clearance);
    double along = 0.0;
    while (true) {
        const Vec2d place = whole > 0.0 ? point_on(way, along / whole) : way.start;
        const double room = region.nearest(place, clearance + kFar) - clearance;
        const bool either = clearance < kHardly || along == 0.0;
        if (room < -0.5 * kSlack || (either && !region.contains(place))) {
            return false;
        }
        if (along == whole) {
            return true;
        }
        along = std::min(whole, along + std::max(room, shortest));
    }
}

}  // namespace cusp::clearing
