// The arc written for a planned one: ends, centre and radius are rounded to the last decimal.
// Coordinates are in units of the last decimal, in the plane of the arc.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/vec.hpp"
#include "host_tools/geometry/toolpath/arc_geometry.hpp"

namespace cusp::toolpath {

// The centre that suits the rounded ends: on their bisector, then rounded to the whole point with
// the least difference of radii.
std::array<std::int64_t, 2> fitted_centre(Vec2d start, Vec2d end, Vec2d wanted);

// The centre of the arc of this radius, of at most a half turn.
Vec2d centre_of_radius(Vec2d start, Vec2d end, double radius, bool clockwise);

// mm: the largest deviation of the written arc from the circle of the planned one, at 33 points.
double arc_deviation(const ArcShape& written, const ArcTo& planned);

}  // namespace cusp::toolpath
