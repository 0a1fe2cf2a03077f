// The true shape of an ArcTo: radius, sweep, points and tangents, helices included.
#pragma once

#include <array>

#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::toolpath {

// The axes of an arc's plane in the order in which counter-clockwise turns the first to the
// second, then the axis of a helix' travel.
std::array<unsigned, 3> axes_of(ArcPlane plane);

struct ArcShape {
    std::array<unsigned, 3> axes;
    Vec3d start;
    Vec3d end;
    double centre_first;
    double centre_second;
    double start_angle;   // radians
    double sweep;         // radians, positive counter-clockwise; a full turn where start is end
    double start_radius;  // mm; the radius goes to end_radius linearly in the angle
    double end_radius;
};

ArcShape arc_shape(Vec3d start, const ArcTo& arc);

// share in [0, 1] of the sweep
Vec3d point_on(const ArcShape& arc, double share);
Vec3d tangent_on(const ArcShape& arc, double share);  // unit
double length(const ArcShape& arc);                   // of the helix, with the mean radius

}  // namespace cusp::toolpath
