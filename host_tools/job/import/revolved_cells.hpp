// The parts of a face of a ring, cone or cylinder in quarters of its turns.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "firmware/base/vec.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/job/import/face_edges.hpp"

namespace cusp::import {

// A surface of revolution of a circle or of a line, mm. Its points have the angle u about the axis, and v
// along the profile: an angle from outside towards the axis for a circle, mm for a line.
struct Revolved {
    Vec3d origin;
    std::array<Vec3d, 3> axes;  // right-handed; the last one is that of revolution
    double radius;              // of the circle's middle, or where v = 0 on the line
    double tube;                // the circle's radius; 0: a line
    double slope;  // of a line, radians from the axis, outwards: along is (sin, cos) of it

    bool is_ring() const { return tube > 0; }
    // Distance from the axis and height along it.
    Vec2d profile(double v) const;
    // (u, v, 0) and its tangent; u within -pi and pi, and v of a ring.
    PointAndTangent uv_of(const PointAndTangent& at) const;
    // mm: how far a point lies beside the surface.
    double off(Vec3d point) const;
};

// A cell reaches from low to high in (u, v); u is a quarter turn, v of a ring also.
struct RevolvedCell {
    Vec2d low, high;
    std::vector<FaceLoop>
        loops;  // closed, in (u, v) near the cell; what they enclose is on their left
};

// Cells of a face that has a part in them.
//
// edges  in (u, v), z = 0, at any turn; each end meets the beginning of another one, or of its own. On a
//        line at least one.
// gap    mm: how far ends that meet may lie apart
// place  begins the message
//
// Errors: InputError where edges do not close, or bound no face.
std::vector<RevolvedCell> revolved_cells(const Revolved& surface,
                                         const std::vector<FaceEdge>& edges,
                                         double gap,
                                         const std::string& place);

}  // namespace cusp::import
