// From which sides a ball can leave little over a place, and which of them contacts bar.
#pragma once

#include <array>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::host {

// A ball that leaves just a given height over a place has its middle on a half sphere over the
// point there: at the point and radius times a unit vector that does not point down. A contact
// bars the vectors from which the ball, or its shank, would cut into it: those of a cap of the
// sphere, as far as it is the ball. So a contact bars all of a triangle on the sphere, whose sides
// are great circles, where it bars its corners, and nothing is lost by the size of the triangle.
class BallDirections {
public:
    // point           what the ball is to leave: it passes through it
    // radius          mm, of the ball
    // contact_radius  mm, of the ball that touches the contacts; not less
    BallDirections(Vec3d point, double radius, double contact_radius);

    void add(Vec3d contact);

    // Of unit vectors.
    using Triangle = std::array<Vec3d, 3>;
    static std::array<Triangle, 4> half_sphere();
    static std::array<Triangle, 4> quarters(const Triangle& triangle);
    static Vec3d middle(const Triangle& triangle);

    // Whether some contact bars all of the triangle.
    bool bars(const Triangle& triangle);

    // Middle of a ball.
    Vec3d centre(Vec3d direction) const { return point_ + direction * radius_; }

private:
    struct Barrier {
        Vec3d way;     // from the point to the contact
        double least;  // mm: vectors that go farther along the way are barred
    };
    bool bars_shank(const Barrier& barrier, const Triangle& triangle, double stretch) const;

    Vec3d point_;
    double radius_;
    double contact_radius_;
    std::vector<Barrier> barriers_;
};

}  // namespace cusp::host
