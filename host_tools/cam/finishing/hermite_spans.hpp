// Cubic Hermite spans through dense points: Bezier pieces with the points' tangents at their ends.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "host_tools/cam/finishing/gouge_free_path.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::finishing {

struct HermiteSpan {
    std::array<Vec3d, 4> bezier;
    double length;  // mm, of the polyline through the points
};

// Unit tangent at a dense point from its neighbours (derivative of the parabola through three).
Vec3d tangent_at(const Points& p, std::size_t k);

// way      mm, of each point: the length of the polyline up to it
// tangent  of each point, a unit vector
HermiteSpan hermite_span(const Points& p,
                         const std::vector<double>& way,
                         const Points& tangent,
                         std::size_t from,
                         std::size_t to);

// True if the points `from` to `to` lie within `allowed` mm of the span.
bool hermite_span_fits(const HermiteSpan& span,
                       const Points& p,
                       const std::vector<double>& way,
                       std::size_t from,
                       std::size_t to,
                       double allowed);

// The curve through consecutive spans, at least one.
nurbs::Curve joined(const std::vector<HermiteSpan>& spans);

}  // namespace cusp::finishing
