// The cosine rule in the triangle of centre of curvature, ball centre and crest of the scallop.
#include "host_tools/geometry/toolpath/stepover.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::toolpath {

double stepover(double radius, double scallop_height, double curvature, double widest)
{
    constexpr double kTightest = 0.98;  // radius times the hollow curvature that counts
    const double h = std::min(scallop_height, radius);
    const double k = std::max(curvature, -kTightest / radius);
    // The cosine of half the angle between the contacts has this sign: beyond a right angle the
    // hollow is as round as the ball, and no scallop gets that high.
    if (1 + 2 * radius * k + (1 + h * k) * (1 + h * k) <= 0) {
        return widest * radius;
    }
    const double square =
        h * (2 * radius - h) * (4 + 4 * (radius + h) * k + (2 * radius * h + h * h) * k * k);
    const double below = (1 + radius * k) * (1 + h * k);
    return std::min(widest * radius, std::sqrt(std::max(0.0, square)) / below);
}

}  // namespace cusp::toolpath
