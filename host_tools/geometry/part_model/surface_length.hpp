// Lengths on surfaces: a bound of isocurves, and polylines between two points.
#pragma once

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"

namespace cusp::part_model {

// mm: upper bound of the lengths of isocurves along u, or v: the longest row of control points.
double longest_row(const nurbs::Surface& surface, bool along_u);

// mm: length of the polyline through `parts` + 1 points at equal steps on a segment in (u, v).
double length_between(const PartModel& model, int surface, Vec2d from, Vec2d to, int parts);

}  // namespace cusp::part_model
