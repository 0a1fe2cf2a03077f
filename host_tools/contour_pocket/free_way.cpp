// Looks at places near enough that no corner stands out between two.
#include "host_tools/contour_pocket/free_way.hpp"

#include <cmath>

namespace cusp::host {

bool is_free(const RegionOffset& walls, const Edge& way, double least)
{
    constexpr double kSpacing = 0.05;
    // A corner abreast of the middle between two places is that much farther from both.
    const double abreast = std::hypot(least, 0.5 * kSpacing);
    const int n = 1 + static_cast<int>(length(way) / kSpacing);
    for (int i = 0; i <= n; ++i) {
        const Vec2d p = point_on(way, static_cast<double>(i) / n);
        if (walls.any_nearer(p, abreast) || !walls.contains(p)) {
            return false;
        }
    }
    return true;
}

}  // namespace cusp::host
