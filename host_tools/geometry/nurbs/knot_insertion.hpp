// Boehm's knot insertion on rows of homogeneous control points: one row for a curve, many for a
// surface.
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::nurbs {

struct HomogeneousPoint {
    double x, y, z, w;  // x, y, z carry the factor w
};

// From a (share 0) to b (share 1).
HomogeneousPoint blend(const HomogeneousPoint& a, const HomogeneousPoint& b, double share);

// One direction of a tensor product: control row i is `width` points from points[i * width] on.
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
// Replaces the surface's knots and control points in one direction.
void set_rows_along_u(const ControlRows& rows, Surface& surface);
void set_rows_along_v(const ControlRows& rows, Surface& surface);

// The shape with knots of multiplicity degree + 1 at all ends.
Surface clamped(const Surface& surface);
Curve clamped(const Curve& curve);

// The shape with more knots: each one given raises a multiplicity by 1.
// Precondition: knots are inside the domain, with multiplicities of at most the degree afterwards.
Surface with_knots(const Surface& surface,
                   const std::vector<double>& more_u,
                   const std::vector<double>& more_v);

// Multiplicity of u among the knots.
std::size_t multiplicity(const std::vector<double>& knots, double u);

// Inserts u until its multiplicity is at least the degree. The shape does not change.
// Precondition: u in the domain.
void insert_to_degree(ControlRows& rows, double u);

// `from`, the distinct knots between, and `to`, increasing.
std::vector<double> knots_between(const std::vector<double>& knots, double from, double to);

// The distinct knots of the domain, its ends included.
std::vector<double> distinct_knots(const std::vector<double>& knots, int degree, std::size_t count);

// The ends of the domain and the knots where the tangent may jump: of multiplicity degree or more.
std::vector<double> crease_knots(const std::vector<double>& knots, int degree, std::size_t count);

// Inserts every knot of the domain up to multiplicity degree. A span [knots[s], knots[s + 1]] is
// then the Bezier piece of rows s - degree to s.
void insert_all_to_degree(ControlRows& rows);

// Restricts the rows to their domain, with knots of multiplicity degree + 1 at both ends.
void clamp_ends(ControlRows& rows);

// The surface on a larger domain: its outermost polynomials go on. The shape inside the old domain does not
// change.
//
// surface       clamped
// u_begin ...   of the new domain; what lies inside the old one leaves that end as it is
Surface extended(
    const Surface& surface, double u_begin, double u_end, double v_begin, double v_end);

}  // namespace cusp::nurbs
