// Steps as long as the clearance, or so short that no corner reaches in between two points.
#include "host_tools/cam/clearing/clear_path.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::clearing {

using offset::Edge;
using offset::RegionOffset;

namespace {

constexpr double kSlack = 1e-5;  // mm
constexpr double kHardly = 0.1;  // mm: at less clearance points may be on either side of a contour

// A corner between two points h apart is nearest to the path at their middle: nearer than both by
// h^2 / (8 clearance) on a line, and on an arc by its sagitta h^2 / (8 radius) more.
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
