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

}  // namespace cusp::host
