// Distances in closed form: from the plane first, then from sides and corners.
#include "host_tools/geometry/part_model/facet_distance.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::part_model {
namespace {

constexpr double kUpright = 1e-9;  // z of a normal
constexpr double kOnSide = 1e-12;  // of an area, mm2

}  // namespace

Facet::Facet(const std::array<Vec3d, 3>& at) : corners{at}
{
    const Vec3d across = cross(at[1] - at[0], at[2] - at[0]);
    normal = across / (across.z < 0 ? -norm(across) : norm(across));
}

bool Facet::holds(Vec3d p) const
{
    bool left = true;
    bool right = true;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d& a = corners[k];
        const double side = dot(cross(corners[(k + 1) % 3] - a, p - a), normal);
        left = left && side >= -kOnSide;
        right = right && side <= kOnSide;
    }
    return left || right;
}

double facet_distance(const ToolCore& core, const Facet& facet, Vec3d& place, double limit)
{
    Vec3d n = facet.normal;
    if (n.z < kUpright && dot(core.end - facet.corners[0], n) < 0) {
        n = -n;
    }
    const Vec3d from = core.farthest_against(n);
    const double over = dot(from - facet.corners[0], n);
    if (over >= limit) {
        return over;
    }
    if (over > 0) {
        place = from - n * over;
        if (facet.holds(place)) {
            return over;
        }
    } else if (n.z >= kUpright) {
        place = {from.x, from.y, from.z - over / n.z};
        if (facet.holds(place)) {
            return 0;
        }
    }
    double least = limit;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d a = facet.corners[k];
        const Vec3d b = facet.corners[(k + 1) % 3];
        const Vec3d low{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
        const Vec3d high{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
        if (core.distance_to_box(low, high) >= least) {
            continue;
        }
        Vec3d there;
        const double distance = edge_distance(core, {a, b}, there);
        if (distance < least) {
            least = distance;
            place = there;
        }
    }
    return least;
}

std::optional<double> height_at(const Facet& facet, double x, double y)
{
    const Vec3d n = facet.normal;
    const Vec3d a = facet.corners[0];
    if (n.z < kUpright) {
        return std::nullopt;
    }
    const double z = a.z - (n.x * (x - a.x) + n.y * (y - a.y)) / n.z;
    return facet.holds({x, y, z}) ? std::optional{z} : std::nullopt;
}

}  // namespace cusp::part_model
