// Curves as lines and arcs: lines and circles exactly, other curves as biarcs within a tolerance.
#pragma once

#include <array>
#include <optional>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::offset {

// Edges from the curve's start to its end, with common tangents inside the curve.
//
// tolerance  mm, > 0: largest distance of the edges from the curve. Curves that are lines or
//            circles to 1e-8 mm are converted exactly.
std::vector<Edge> fit_edges(const nurbs::Curve& curve, double tolerance);

// The two arcs between two points that leave and arrive with the given unit tangents; none where
// the tangents point away from the chord.
std::optional<std::array<Edge, 2>> biarc_between(Vec2d from,
                                                 Vec2d leaving,
                                                 Vec2d to,
                                                 Vec2d arriving);

// The closed contour of a loop of curves in order. Gaps of up to 1e-3 mm, which the reader accepts,
// are closed by moving ends.
Contour fit_contour(const std::vector<nurbs::Curve>& loop, double tolerance);

}  // namespace cusp::offset
