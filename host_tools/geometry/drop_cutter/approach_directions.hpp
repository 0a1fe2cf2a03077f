// Approach directions of a ball that cuts down to a given height over a point, and the cutter
// contacts that block them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::drop_cutter {

// A ball that cuts down to exactly a point has its centre on a half sphere around that point: at
// the point plus the radius times a unit vector that does not point down. A contact blocks the
// vectors from which the ball, or its shank, would cut into it. Those blocked by the ball form a
// cap of the sphere. Thus a contact that blocks the corners of a spherical triangle (its sides are
// great circles) blocks all of it, however large it is.
class ApproachDirections {
public:
    // point           on the ball's surface
    // radius          mm, of the ball that cuts
    // contact_radius  mm, >= radius: of the ball whose drops gave the contacts
    ApproachDirections(Vec3d point, double radius, double contact_radius);

    // Returns the contact's number, counted from 0.
    std::size_t add(Vec3d contact);
    Vec3d contact(std::size_t number) const { return contacts_[number]; }

    // Corners are unit vectors.
    using Triangle = std::array<Vec3d, 3>;
    static std::array<Triangle, 4> half_sphere();
    static std::array<Triangle, 4> quarters(const Triangle& triangle);
    static Vec3d middle(const Triangle& triangle);
    // These and the triangle's corners have it in their hull: the corners stretched until their plane
    // touches the sphere.
    static Triangle stretched(const Triangle& triangle);

    // True if the contact blocks the whole triangle.
    bool blocks(std::size_t contact, const Triangle& triangle) const;

    // A contact that blocks the whole triangle, if there is one.
    std::optional<std::size_t> blocking(const Triangle& triangle);

    // Centre of the ball approached from a direction (unit vector).
    Vec3d centre(Vec3d direction) const { return point_ + direction * radius_; }

private:
    struct BlockedCap {
        Vec3d direction;  // from the point to the contact
        double least;     // mm: vectors with a larger dot product with `direction` are blocked
        std::size_t contact;
    };
    BlockedCap blocked_cap(std::size_t contact) const;
    bool blocks(const BlockedCap& cap, const Triangle& triangle) const;
    bool blocks_shank(const BlockedCap& cap, const Triangle& triangle) const;

    Vec3d point_;
    double radius_;
    double contact_radius_;
    std::vector<Vec3d> contacts_;
    std::vector<BlockedCap> blocked_caps_;
};

}  // namespace cusp::drop_cutter
