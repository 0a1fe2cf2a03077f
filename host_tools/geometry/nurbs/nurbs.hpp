// NURBS curves and surfaces of any size on the host: evaluation, derivatives, splitting, Bezier
// pieces. Millimetres and doubles throughout.
//
//     const Curve line{1, {0, 0, 1, 1}, {{0, 0, 0}, {10, 0, 0}}, {1, 1}};
//     const Vec3d middle = point_at(line, 0.5);                  // (5, 0, 0)
//     const auto [left, right] = split_at(line, 0.25);
//     for (const BezierPatch& patch : bezier_patches(surface)) {
//         const SurfacePoint p = derivatives_at(patch.surface, patch.u_begin, patch.v_begin);
//         const Vec3d normal = upward_normal(p);
//     }
//
// Parameters outside the domain are clamped to it. knot_insertion.hpp has the operations on knots.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "firmware/base/vec.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::nurbs {

// A rational B-spline curve. Invariants, checked by the readers in host_tools/job/import and assumed
// here: degree >= 1, points.size() == weights.size() >= degree + 1, knots.size() == points.size() +
// degree + 1, knots non-decreasing, domain not empty, weights > 0.
struct Curve {
    int degree{};
    std::vector<double> knots;
    std::vector<Vec3d> points;
    std::vector<double> weights;

    double domain_begin() const { return knots[static_cast<std::size_t>(degree)]; }
    double domain_end() const { return knots[points.size()]; }
};

// A point with the first and second derivative by the parameter.
struct CurvePoint {
    Vec3d point;
    Vec3d first;
    Vec3d second;
};

Vec3d point_at(const Curve& curve, double u);
CurvePoint derivatives_at(const Curve& curve, double u);

// The parts of the curve before and after u, each ending or starting in a knot of multiplicity
// degree + 1. Precondition: domain_begin() < u < domain_end().
std::array<Curve, 2> split_at(const Curve& curve, double u);

// The pieces of the curve between distinct knots, each with full multiplicity at its ends.
std::vector<Curve> bezier_pieces(const Curve& curve);

Curve reversed(const Curve& curve);

// A rational tensor-product surface; control point (i, j) is points[i * size_v + j].
struct Surface {
    int degree_u{};
    int degree_v{};
    std::vector<double> knots_u;
    std::vector<double> knots_v;
    int size_u{};
    int size_v{};
    std::vector<Vec3d> points;
    std::vector<double> weights;
    // Trimming loops of curves in (u, v), z = 0; the outer loop first, counter-clockwise. Empty:
    // not trimmed.
    std::vector<std::vector<Curve>> trims;

    double u_begin() const { return knots_u[static_cast<std::size_t>(degree_u)]; }
    double u_end() const { return knots_u[static_cast<std::size_t>(size_u)]; }
    double v_begin() const { return knots_v[static_cast<std::size_t>(degree_v)]; }
    double v_end() const { return knots_v[static_cast<std::size_t>(size_v)]; }
};

// A surface point with derivatives up to the second.
struct SurfacePoint {
    Vec3d point;
    Vec3d du;
    Vec3d dv;
    Vec3d duu;
    Vec3d duv;
    Vec3d dvv;
};

Vec3d point_at(const Surface& surface, double u, double v);
SurfacePoint derivatives_at(const Surface& surface, double u, double v);

// True if a first derivative, du or dv, is zero but for rounding: at a pole, where a side of the
// surface degenerates to a point. Near a pole the derivative is duv times the distance from it.
bool at_pole(Vec3d derivative, const SurfacePoint& s);

// The unit normal that points up (z >= 0); for a vertical tangent plane, to the left of du. At a
// pole the limit of the normals beside it. Zero where the derivatives are parallel.
Vec3d upward_normal(const SurfacePoint& s);

// The rational Bezier patches of the surface, row by row in u then v, with their domains.
struct BezierPatch {
    Surface surface;  // one span in u and v
    double u_begin, u_end, v_begin, v_end;
};
std::vector<BezierPatch> bezier_patches(const Surface& surface);

// The isocurve at constant v (a curve over u), or at constant u (over v).
Curve isocurve_at_v(const Surface& surface, double v);
Curve isocurve_at_u(const Surface& surface, double u);

}  // namespace cusp::nurbs
