// The cosine rule in the triangle of centre of curvature, ball centre and cusp.
#include "host_tools/contour_pocket/stepover.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::contour_pocket {

using toolpath::Tool;

double stepover(double radius, double scallop_height, double curvature, double slope)
{
    const double flat = 2.0 * std::sqrt(scallop_height * (2.0 * radius - scallop_height));
    const double most = 1.5 * flat;
    const double level = 1.0 / std::sqrt(1.0 + slope * slope);
    if (std::abs(curvature) * radius < 1e-7) {
        return flat * level;
    }
    const double rho = 1.0 / curvature;
    if (rho < 0.0 && -rho <= radius * 1.0001) {
        return flat * level;
    }
    const double to_cusp = scallop_height + rho;
    const double to_centre = radius + rho;
    const double cosine =
        (rho * rho + 2.0 * radius * rho + to_cusp * to_cusp) / (2.0 * to_centre * to_cusp);
    if (std::abs(cosine) >= 1.0) {
        return flat * level;
    }
    const double apart = 2.0 * std::abs(to_centre) * std::sqrt(1.0 - cosine * cosine);
    return std::min(apart, most) * level;
}

double stepover(
    const Tool& tool, double scallop_height, double curvature, double slope, double slope_along)
{
    if (tool.corner_radius >= tool.radius) {
        return stepover(tool.radius, scallop_height, curvature, slope);
    }
    const double corner = tool.corner_radius;
    const double flat = tool.radius - corner;
    const double level = 1.0 / std::sqrt(1.0 + slope * slope);
    // The flat of the foot, tilted by the slope across, rises over the floor by `tilt` a millimetre
    // and by half the curvature times the distance squared.
    const double tilt = std::abs(slope) * level;
    const double bend = std::abs(curvature);
    const double by_flat = 2.0 * scallop_height /
                           (tilt + std::sqrt(tilt * tilt + 2.0 * bend * scallop_height) + 1e-12);
    double interval = std::min(by_flat, 1.8 * flat) * level;
    if (corner > scallop_height) {
        interval = std::max(interval, stepover(corner, scallop_height, curvature, slope));
    }
    // Climbing, the foot's rim sweeps an ellipse as wide as the foot and as high as its tilt.
    const double climb = std::abs(slope_along) / std::sqrt(1.0 + slope_along * slope_along);
    if (climb > 1e-6) {
        const double larger = corner + flat / climb;
        interval = std::min(interval, stepover(larger, scallop_height, curvature, slope));
    }
    return interval;
}

}  // namespace cusp::contour_pocket
