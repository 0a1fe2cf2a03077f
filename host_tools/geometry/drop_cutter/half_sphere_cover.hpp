// Caps of the unit sphere, and the question whether they cover its upper half.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::drop_cutter {

// A closed set that open caps leave uncovered has a border. That is a whole circle of a cap, or it has
// a vertex where two circles cross: the caps cover the half sphere if each vertex and one point of each
// circle lies within another cap. Caps are added one by one, where a direction is still open.
//
//     HalfSphereCover cover;
//     while (const std::optional<Vec3d> open = cover.open()) {
//         cover.add(cap_over(*open));
//     }
class HalfSphereCover {
public:
    // Without caps: the whole half sphere is open.
    HalfSphereCover();

    // The unit vectors d with dot(d, towards) > least.
    struct Cap {
        Vec3d towards;  // unit vector
        double least;
    };
    // Returns false if the cap adds nothing: it lies within another, or is that but for rounding.
    bool add(const Cap& cap);

    // A direction that does not point down and that no cap holds, or not by more than rounding, in the
    // middle of others if possible; none if the caps cover the half sphere.
    std::optional<Vec3d> open();

private:
    struct Place {
        Vec3d direction;
        double off;    // how far it may be off, by rounding
        Vec3d away{};  // from the caps whose circles it lies on
    };
    bool is_held(const Place& place) const;
    Vec3d within(const Place& corner) const;
    void add_vertices(const Cap& cap, const Cap& other);

    std::vector<Cap> caps_;  // the first is the lower half
    std::vector<Place> open_;
};

}  // namespace cusp::drop_cutter
