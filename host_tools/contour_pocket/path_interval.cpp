// The cosine rule in the triangle of centre of curvature, ball centre and cusp.
#include "host_tools/contour_pocket/path_interval.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::host {

double path_interval(double radius, double cusp, double curvature, double slope)
{
    const double flat = 2.0 * std::sqrt(cusp * (2.0 * radius - cusp));
    const double most = 1.5 * flat;
    const double level = 1.0 / std::sqrt(1.0 + slope * slope);
    if (std::abs(curvature) * radius < 1e-7) {
        return flat * level;
    }
    const double rho = 1.0 / curvature;
    if (rho < 0.0 && -rho <= radius * 1.0001) {
        return flat * level;
    }
    const double to_cusp = cusp + rho;
    const double to_centre = radius + rho;
    const double cosine =
        (rho * rho + 2.0 * radius * rho + to_cusp * to_cusp) / (2.0 * to_centre * to_cusp);
    if (std::abs(cosine) >= 1.0) {
        return flat * level;
    }
    const double apart = 2.0 * std::abs(to_centre) * std::sqrt(1.0 - cosine * cosine);
    return std::min(apart, most) * level;
}

double path_interval(
    const Tool& tool, double cusp, double curvature, double slope, double slope_along)
{
    if (tool.corner_radius >= tool.radius) {
        return path_interval(tool.radius, cusp, curvature, slope);
    }
    const double corner = tool.corner_radius;
    const double flat = tool.radius - corner;
    const double level = 1.0 / std::sqrt(1.0 + slope * slope);
    // The flat of the foot, tilted by the slope across, rises over the floor by `tilt` a millimetre
    // and by half the curvature times the distance squared.
    const double tilt = std::abs(slope) * level;
    const double bend = std::abs(curvature);
    const double by_flat = 2.0 * cusp / (tilt + std::sqrt(tilt * tilt + 2.0 * bend * cusp) + 1e-12);
    double interval = std::min(by_flat, 1.8 * flat) * level;
    if (corner > cusp) {
        interval = std::max(interval, path_interval(corner, cusp, curvature, slope));
    }
    // Climbing, the foot's rim sweeps an ellipse as wide as the foot and as high as its tilt.
    const double climb = std::abs(slope_along) / std::sqrt(1.0 + slope_along * slope_along);
    if (climb > 1e-6) {
        const double larger = corner + flat / climb;
        interval = std::min(interval, path_interval(larger, cusp, curvature, slope));
    }
    return interval;
}

}  // namespace cusp::host
