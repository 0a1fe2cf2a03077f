// Heights of triangles, and the width of them all.
#include "host_tools/job/import/facets.hpp"

#include <algorithm>

namespace cusp::import {
namespace {

double width_along(double Vec3d::*axis, const Facets& facets)
{
    double low = facets.triangles.front()[0].*axis;
    double high = low;
    for (const auto& t : facets.triangles) {
        for (const Vec3d& p : t) {
            low = std::min(low, p.*axis);
            high = std::max(high, p.*axis);
        }
    }
    return high - low;
}

}  // namespace

void add_facet(const std::array<Vec3d, 3>& corners, Facets& facets)
{
    constexpr double kLeastHeight = 1e-9;  // mm
    const double area2 = norm(cross(corners[1] - corners[0], corners[2] - corners[0]));
    const double longest = std::max({norm(corners[1] - corners[0]), norm(corners[2] - corners[1]),
                                     norm(corners[0] - corners[2])});
    if (area2 > kLeastHeight * longest) {
        facets.triangles.push_back(corners);
    } else {
        ++facets.degenerate;
    }
}

void check_facets(const Facets& facets, const std::string& file)
{
    if (facets.triangles.empty()) {
        throw InputError(
            fmt::format("{}: holds no facet with an area ({} without)", file, facets.degenerate));
    }
    const double in_x = width_along(&Vec3d::x, facets);
    const double in_y = width_along(&Vec3d::y, facets);
    if (!(in_x > 0 && in_y > 0)) {
        throw InputError(
            fmt::format("{}: is {:g} mm wide in x and {:g} mm in y: a floor must be wider than 0",
                        file, in_x, in_y));
    }
}

}  // namespace cusp::import
