// Cubic pieces through dense points, with the points' tangents at their ends.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "host_tools/finishing/gouge_free_path.hpp"
#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::finishing {

struct HermiteSpan {
    std::array<Vec3d, 4> bezier;
    double length;  // mm, along the points
};

// Unit tangent at a dense point from its neighbours (derivative of the parabola through three).
Vec3d tangent_at(const Points& p, std::size_t k);

// way      mm, of each point along all of them
// tangent  unit, at each point
HermiteSpan hermite_span(const Points& p,
                         const std::vector<double>& way,
                         const Points& tangent,
                         std::size_t from,
                         std::size_t to);

// Whether the points between its ends lie within `allowed` mm of the span.
bool hermite_span_fits(const HermiteSpan& span,
                       const Points& p,
                       const std::vector<double>& way,
                       std::size_t from,
                       std::size_t to,
                       double allowed);

// One curve of at least one span, each starting where the one before ends.
nurbs::Curve joined(const std::vector<HermiteSpan>& spans);

}  // namespace cusp::finishing
