// Curves as lines and arcs: exact where they are lines or circles, biarcs within a tolerance
// elsewhere.
#pragma once

#include <array>
#include <optional>

#include "host_tools/offset/contour.hpp"

namespace cusp::offset {

// Edges from the curve's start to its end, joined with a common tangent inside the curve.
//
//   tolerance  mm, > 0: largest distance of the edges from a free curve. Curves that are circles or
//              lines to 1e-8 mm are taken as such.
std::vector<Edge> fit_edges(const nurbs::Curve& curve, double tolerance);

// Two arcs from one point to another that leave and arrive with the given unit tangents; no value
// where the tangents point away from the way between.
std::optional<std::array<Edge, 2>> biarc_between(Vec2d from,
                                                 Vec2d leaving,
                                                 Vec2d to,
                                                 Vec2d arriving);

// The closed contour of a loop of curves in order. Gaps of up to 1e-3 mm (what the reader accepts)
// are closed by moving ends.
Contour fit_contour(const std::vector<nurbs::Curve>& loop, double tolerance);

}  // namespace cusp::offset
