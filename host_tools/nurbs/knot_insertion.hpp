// Boehm's knot insertion on rows of homogeneous control points: one row a curve, many a surface.
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::nurbs {

struct HomogeneousPoint {
    double x, y, z, w;  // x, y, z carry the factor w
};

// One direction of a tensor product: control row i is points[i * width] ... of `width` points.
struct ControlRows {
    int degree{};
    std::vector<double> knots;
    std::size_t width{1};
    std::vector<HomogeneousPoint> points;

    std::size_t rows() const { return points.size() / width; }
};

ControlRows control_rows(const Curve& curve);
// Rows follow u (width size_v) or v (width size_u).
ControlRows control_rows_along_u(const Surface& surface);
ControlRows control_rows_along_v(const Surface& surface);

Curve to_curve(const ControlRows& rows);

// The surface with its ends clamped in both directions, if they are not already.
Surface clamped(const Surface& surface);
Curve clamped(const Curve& curve);

// The same shape with more knots, each once more than it is listed in the surface.
// Precondition: they lie inside the domain, and none gets over the degree.
Surface with_knots(const Surface& surface,
                   const std::vector<double>& more_u,
                   const std::vector<double>& more_v);

// Multiplicity of u among the knots.
std::size_t multiplicity(const std::vector<double>& knots, double u);

// Inserts u until its multiplicity is at least the degree. The shape does not change.
// Precondition: u in the domain.
void insert_to_degree(ControlRows& rows, double u);

// Both ends of a part of the domain, and the distinct knots between them, rising.
std::vector<double> knots_between(const std::vector<double>& knots, double from, double to);

// The distinct knots of the domain, its ends included.
std::vector<double> distinct_knots(const std::vector<double>& knots, int degree, std::size_t count);

// Of those the ends, and the knots where the tangent may jump: of multiplicity degree or more.
std::vector<double> crease_knots(const std::vector<double>& knots, int degree, std::size_t count);

// Inserts every knot of the domain to the degree. Span [knots[s], knots[s + 1]] then is a Bezier
// piece of rows s - degree to s.
void insert_all_to_degree(ControlRows& rows);

// Cuts the rows to their domain: knots of multiplicity degree + 1 at both ends, the same shape.
void clamp_ends(ControlRows& rows);

}  // namespace cusp::nurbs
