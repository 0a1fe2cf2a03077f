// The stepover of contacts, converted to that of the ball's centres in plan.
#include "host_tools/cam/contour_pocket/plan_stepover.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/toolpath/stepover.hpp"

namespace cusp::contour_pocket {

using drop_cutter::DropCutter;
using toolpath::stepover;
using toolpath::Tool;

double plan_stepover(double radius, double scallop_height, double curvature, double slope)
{
    constexpr double kWidest = 1.5;  // times that of a flat floor
    constexpr double kNoRoom = 1e-4;
    const double flat = stepover(radius, scallop_height, 0.0);
    const double cosine = 1.0 / std::sqrt(1.0 + slope * slope);
    // Centres are farther apart than contacts by this factor.
    const double outward = 1.0 + radius * curvature;
    const double contacts = stepover(radius, scallop_height, curvature, kInfinite);
    if (outward < kNoRoom || contacts == kInfinite) {
        return flat * cosine;
    }
    return std::min(contacts * outward, kWidest * flat) * cosine;
}

double plan_stepover(const Tool& tool, double scallop_height, const DropCutter::Section& section)
{
    const double slope = section.slope;
    const double curvature = section.curvature;
    if (tool.corner_radius >= tool.radius) {
        return plan_stepover(tool.radius, scallop_height, curvature, slope);
    }
    const double corner = tool.corner_radius;
    const double flat = tool.radius - corner;
    const double cosine = 1.0 / std::sqrt(1.0 + slope * slope);
    // The flat bottom, tilted by the slope across, is above the floor by `tilt` per millimetre and
    // by half the curvature times the squared distance.
    const double tilt = std::abs(slope) * cosine;
    const double bend = std::abs(curvature);
    const double by_flat = 2.0 * scallop_height /
                           (tilt + std::sqrt(tilt * tilt + 2.0 * bend * scallop_height) + 1e-12);
    double interval = std::min(by_flat, 1.8 * flat) * cosine;
    if (corner > scallop_height) {
        interval = std::max(interval, plan_stepover(corner, scallop_height, curvature, slope));
    }
    // On a climbing pass the rim of the bottom sweeps an ellipse as wide as the bottom and as high
    // as its tilt.
    const double climb =
        std::abs(section.slope_along) / std::sqrt(1.0 + section.slope_along * section.slope_along);
    if (climb > 1e-6) {
        const double larger = corner + flat / climb;
        interval = std::min(interval, plan_stepover(larger, scallop_height, curvature, slope));
    }
    return interval;
}

}  // namespace cusp::contour_pocket
