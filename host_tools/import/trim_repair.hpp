// Repairs rounding and conversion errors in the trimming loops of CAD faces.
#pragma once

#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

// Moves points just outside the domain into it, and joins ends that nearly meet.
void tidy(std::vector<nurbs::Curve>& loop, const nurbs::Surface& surface);

// An edge that is a point, as at a pole or where a fillet runs out, has no length, and its
// converted parameters are wrong. Puts a line in (u, v) in its place: after the curves that
// `point_follows` names, and where ends lie at the same pole. Returns how long the longest of these
// lines is on the surface, in mm, which is more than rounding where the file is wrong.
double bridge_points(std::vector<nurbs::Curve>& loop,
                     const std::vector<bool>& point_follows,
                     const nurbs::Surface& surface);

}  // namespace cusp::import
