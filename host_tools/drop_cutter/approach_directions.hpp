// From which sides a ball can leave little over a place, and which of them contacts bar.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::drop_cutter {

// A ball that leaves just a given height over a place has its middle on a half sphere over the
// point there: at the point and radius times a unit vector that does not point down. A contact
// bars the vectors from which the ball, or its shank, would cut into it: those of a cap of the
// sphere, as far as it is the ball. So a contact bars all of a triangle on the sphere, whose sides
// are great circles, where it bars its corners, and nothing is lost by the size of the triangle.
class ApproachDirections {
public:
    // point           what the ball is to leave: it passes through it
    // radius          mm, of the ball
    // contact_radius  mm, of the ball that touches the contacts; not less
    ApproachDirections(Vec3d point, double radius, double contact_radius);

    // Returns the contact's number: from 0, one more each time.
    std::size_t add(Vec3d contact);
    Vec3d contact(std::size_t number) const { return contacts_[number]; }

    // Of unit vectors.
    using Triangle = std::array<Vec3d, 3>;
    static std::array<Triangle, 4> half_sphere();
    static std::array<Triangle, 4> quarters(const Triangle& triangle);
    static Vec3d middle(const Triangle& triangle);

    // Whether the contact bars all of the triangle.
    bool blocks(std::size_t contact, const Triangle& triangle) const;

    // A contact that bars all of the triangle.
    std::optional<std::size_t> blocking(const Triangle& triangle);

    // Middle of a ball.
    Vec3d centre(Vec3d direction) const { return point_ + direction * radius_; }

private:
    struct BlockedCap {
        Vec3d direction;  // from the point to the contact
        double least;     // mm: vectors that go farther along the way are barred
        std::size_t contact;
    };
    BlockedCap blocked_cap(std::size_t contact) const;
    bool blocks(const BlockedCap& barrier, const Triangle& triangle) const;
    bool blocks_shank(const BlockedCap& barrier, const Triangle& triangle) const;

    Vec3d point_;
    double radius_;
    double contact_radius_;
    std::vector<Vec3d> contacts_;
    std::vector<BlockedCap> blocked_caps_;
};

}  // namespace cusp::drop_cutter
