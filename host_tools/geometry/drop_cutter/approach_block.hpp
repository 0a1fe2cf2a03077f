// Directions from which a ball cuts down to a point, and those of them that a contact blocks.
#pragma once

#include <algorithm>

#include "host_tools/geometry/drop_cutter/half_sphere_cover.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::drop_cutter {

// A ball that cuts down to exactly a point has its centre on a half sphere around that point: at the point
// plus the radius times a unit vector n that does not point down. A contact blocks the vectors from which
// the ball, or its shank, would cut into it: |point + R n - contact| < R' is linear in n, a cap.
struct ApproachBlock {
    HalfSphereCover::Cap cap;
    double margin{-1};  // how far the direction of the ball lies within the cap; negative: outside
    Vec3d contact;
};

// centre          of a ball that cuts down to the point. It cuts into what it covers from above, so points
//                 straight below a contact block as well.
// radius          mm, of the ball that cuts
// contact_radius  mm, >= radius: of the ball that touches contacts
inline ApproachBlock approach_block(
    Vec3d contact, Vec3d point, Vec3d centre, double radius, double contact_radius)
{
    constexpr double kOnPoint = 1e-9;  // mm
    const Vec3d way = Vec3d{contact.x, contact.y, std::min(contact.z, centre.z)} - point;
    const double away = std::max(norm(way), kOnPoint);
    const Vec3d towards = way / away;
    const double least =
        (away * away + radius * radius - contact_radius * contact_radius) / (2 * radius * away);
    return {{towards, least}, dot(towards, centre - point) / radius - least, contact};
}

}  // namespace cusp::drop_cutter
