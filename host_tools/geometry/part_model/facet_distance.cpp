// Distances in closed form: from the plane first, then from sides and corners.
#include "host_tools/geometry/part_model/facet_distance.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::part_model {
namespace {

constexpr double kUpright = 1e-9;  // z of a normal
constexpr double kOnSide = 1e-12;  // of an area, mm2

double square_in_plan(Vec3d p, double x, double y)
{
    return (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y);
}

// The ball dropped on the side between two corners: the upper of two roots; none where it touches
// the line beyond a corner.
std::optional<FacetContact> drop_ball_on_side(Vec3d a, Vec3d b, double x, double y, double radius)
{
    const Vec3d d = b - a;
    const double square = dot(d, d);
    const double cos_square = (d.x * d.x + d.y * d.y) / square;
    if (cos_square < 1e-14) {
        return std::nullopt;
    }
    const double along = ((x - a.x) * d.x + (y - a.y) * d.y);
    const double half = along * d.z / square;
    const double constant = square_in_plan(a, x, y) - along * along / square - radius * radius;
    const double root = half * half - cos_square * constant;
    if (root < 0) {
        return std::nullopt;
    }
    const double rise = (half + std::sqrt(root)) / cos_square;
    const double share = (along + rise * d.z) / square;
    if (share < 0 || share > 1) {
        return std::nullopt;
    }
    return FacetContact{a.z + rise, a + d * share};
}

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
    Vec3d from = core.end;
    const double tilt = elementary::hypot(n.x, n.y);
    if (n.z < kUpright && dot(from - facet.corners[0], n) < 0) {
        n = -n;
    }
    if (core.radius > 0 && tilt > 0) {
        from = from - Vec3d{n.x, n.y, 0} * (core.radius / tilt);
    }
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

std::optional<FacetContact> drop_ball_on_facet(
    const Facet& facet, double x, double y, double radius, double least)
{
    const Vec3d n = facet.normal;
    const std::array<Vec3d, 3>& at = facet.corners;
    if (n.z >= kUpright) {
        const double up = (radius - n.x * (x - at[0].x) - n.y * (y - at[0].y)) / n.z;
        const Vec3d centre{x, y, at[0].z + up};
        // A ball on the facet is never higher than one on the facet's plane.
        if (centre.z < least) {
            return std::nullopt;
        }
        const Vec3d contact = centre - n * radius;
        if (facet.holds(contact)) {
            return FacetContact{centre.z, contact};
        }
    }
    std::optional<FacetContact> best;
    const auto take = [&](const FacetContact& other) {
        if (!best || other.centre > best->centre) {
            best = other;
        }
    };
    for (std::size_t k = 0; k < 3; ++k) {
        if (const auto side = drop_ball_on_side(at[k], at[(k + 1) % 3], x, y, radius)) {
            take(*side);
        }
        const double up = radius * radius - square_in_plan(at[k], x, y);
        if (up >= 0) {
            take({at[k].z + std::sqrt(up), at[k]});
        }
    }
    return best;
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
