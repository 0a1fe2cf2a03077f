// Intersections of two edges.
#pragma once

#include "firmware/base/static_vector.hpp"
#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::offset {

// Points common to both edges: crossings and touches, or the ends of a common part. `overrun` (mm)
// is how far beyond an end a crossing still counts.
using Crossings = StaticVector<Vec2d, 4>;
Crossings crossings(const Edge& a, const Edge& b, double overrun);

}  // namespace cusp::offset
