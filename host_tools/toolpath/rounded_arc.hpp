// The arc that is written for a planned one: between rounded ends, with a centre or a radius that
// the last decimal can say. Places are in units of the last decimal, in the plane of the arc.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/vec.hpp"
#include "host_tools/toolpath/arc_geometry.hpp"

namespace cusp::toolpath {

// The centre that suits the rounded ends: on their bisector, then rounded to the whole point with
// the least difference of radii.
std::array<std::int64_t, 2> fitted_centre(Vec2d start, Vec2d end, Vec2d wanted);

// The centre of the arc of this radius, of at most a half turn.
Vec2d centre_of_radius(Vec2d start, Vec2d end, double radius, bool clockwise);

// mm: how far the written arc leaves the circle of the planned one, at the most of 33 places.
double arc_deviation(const ArcShape& written, const ArcTo& planned);

}  // namespace cusp::toolpath
