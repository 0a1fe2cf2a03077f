// Surfaces: evaluation by basis functions, isocurves and Bezier patches.
#include <cmath>

#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/nurbs/spline_basis.hpp"

namespace cusp::nurbs {
namespace {

// The control points of an isocurve: rows of control points of the surface, blended by the basis
// functions at one parameter.
//
// knots    across the isocurve, of `count` rows
// place    place(row, k): index of the k-th control point of a row in the surface
// along    of the isocurve: degree, knots, and room for its points
template <class Place>
Curve blended(const Surface& surface,
              const std::vector<double>& knots,
              int degree,
              int count,
              double parameter,
              ControlRows along,
              const Place& place)
{
    SplineBasis basis;
    evaluate_basis(knots, degree, static_cast<std::size_t>(count), parameter, false, basis);
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree); ++i) {
        for (std::size_t k = 0; k < along.points.size(); ++k) {
            const std::size_t at = place(basis.first + i, k);
            const double share = basis.value[i];
            const double weight = surface.weights[at];
            HomogeneousPoint& to = along.points[k];
            to.x += share * (surface.points[at].x * weight);
            to.y += share * (surface.points[at].y * weight);
            to.z += share * (surface.points[at].z * weight);
            to.w += share * weight;
        }
    }
    return to_curve(along);
}

std::vector<double> bezier_knots(int degree, double begin, double end)
{
    std::vector<double> knots(static_cast<std::size_t>(degree) + 1, begin);
    knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, end);
    return knots;
}

// The rows of one span, as a patch of a single span along the direction of the rows.
struct Strip {
    double begin, end;
    std::vector<HomogeneousPoint> points;
};

std::vector<Strip> strips(ControlRows rows, double begin, double end)
{
    insert_all_to_degree(rows);
    const auto p = static_cast<std::size_t>(rows.degree);
    std::vector<Strip> out;
    for (std::size_t s = p; s < rows.rows(); ++s) {
        const double low = rows.knots[s];
        const double high = rows.knots[s + 1];
        if (low < high && low >= begin && high <= end) {
            const auto from =
                rows.points.begin() + static_cast<std::ptrdiff_t>((s - p) * rows.width);
            const auto to = rows.points.begin() + static_cast<std::ptrdiff_t>((s + 1) * rows.width);
            out.push_back({low, high, {from, to}});
        }
    }
    return out;
}

// From rows along one direction to rows along the other.
std::vector<HomogeneousPoint> transposed(const std::vector<HomogeneousPoint>& points,
                                         std::size_t width)
{
    const std::size_t rows = points.size() / width;
    std::vector<HomogeneousPoint> out;
    out.reserve(points.size());
    for (std::size_t j = 0; j < width; ++j) {
        for (std::size_t i = 0; i < rows; ++i) {
            out.push_back(points[i * width + j]);
        }
    }
    return out;
}

// The points of `v` stand in rows along v.
BezierPatch make_patch(const Surface& surface, const Strip& u, const Strip& v)
{
    BezierPatch patch{{}, u.begin, u.end, v.begin, v.end};
    patch.surface.degree_u = surface.degree_u;
    patch.surface.degree_v = surface.degree_v;
    patch.surface.size_u = surface.degree_u + 1;
    patch.surface.size_v = surface.degree_v + 1;
    patch.surface.knots_u = bezier_knots(surface.degree_u, u.begin, u.end);
    patch.surface.knots_v = bezier_knots(surface.degree_v, v.begin, v.end);
    const auto width = static_cast<std::size_t>(surface.degree_u) + 1;
    for (const HomogeneousPoint& h : transposed(v.points, width)) {
        patch.surface.points.push_back({h.x / h.w, h.y / h.w, h.z / h.w});
        patch.surface.weights.push_back(h.w);
    }
    return patch;
}

}  // namespace

Vec3d point_at(const Surface& surface, double u, double v)
{
    SplineBasis along_u;
    SplineBasis along_v;
    const auto size_u = static_cast<std::size_t>(surface.size_u);
    const auto size_v = static_cast<std::size_t>(surface.size_v);
    evaluate_basis(surface.knots_u, surface.degree_u, size_u, u, false, along_u);
    evaluate_basis(surface.knots_v, surface.degree_v, size_v, v, false, along_v);
    Vec3d sum;
    double weight = 0;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(surface.degree_u); ++i) {
        const std::size_t row = (along_u.first + i) * size_v + along_v.first;
        for (std::size_t j = 0; j <= static_cast<std::size_t>(surface.degree_v); ++j) {
            const double share = along_u.value[i] * along_v.value[j] * surface.weights[row + j];
            sum = sum + share * surface.points[row + j];
            weight += share;
        }
    }
    return sum / weight;
}

SurfacePoint derivatives_at(const Surface& surface, double u, double v)
{
    SplineBasis bu;
    SplineBasis bv;
    const auto size_u = static_cast<std::size_t>(surface.size_u);
    const auto size_v = static_cast<std::size_t>(surface.size_v);
    evaluate_basis(surface.knots_u, surface.degree_u, size_u, u, true, bu);
    evaluate_basis(surface.knots_v, surface.degree_v, size_v, v, true, bv);
    // a[k], w[k]: value, u, v, uu, uv, vv of the homogeneous point
    std::array<Vec3d, 6> a{};
    std::array<double, 6> w{};
    for (std::size_t i = 0; i <= static_cast<std::size_t>(surface.degree_u); ++i) {
        // the sums along v: value, first and second derivative
        std::array<Vec3d, 3> row{};
        std::array<double, 3> row_weight{};
        const std::size_t first = (bu.first + i) * size_v + bv.first;
        for (std::size_t j = 0; j <= static_cast<std::size_t>(surface.degree_v); ++j) {
            const double weight = surface.weights[first + j];
            const Vec3d p = weight * surface.points[first + j];
            row[0] = row[0] + bv.value[j] * p;
            row[1] = row[1] + bv.first_derivative[j] * p;
            row[2] = row[2] + bv.second_derivative[j] * p;
            row_weight[0] += bv.value[j] * weight;
            row_weight[1] += bv.first_derivative[j] * weight;
            row_weight[2] += bv.second_derivative[j] * weight;
        }
        const std::array<double, 6> share{bu.value[i],
                                          bu.first_derivative[i],
                                          bu.value[i],
                                          bu.second_derivative[i],
                                          bu.first_derivative[i],
                                          bu.value[i]};
        constexpr std::array<std::size_t, 6> kOrderInV{0, 0, 1, 0, 1, 2};
        for (std::size_t k = 0; k < 6; ++k) {
            a[k] = a[k] + share[k] * row[kOrderInV[k]];
            w[k] += share[k] * row_weight[kOrderInV[k]];
        }
    }
    SurfacePoint s;
    s.point = a[0] / w[0];
    s.du = (a[1] - w[1] * s.point) / w[0];
    s.dv = (a[2] - w[2] * s.point) / w[0];
    s.duu = (a[3] - 2 * w[1] * s.du - w[3] * s.point) / w[0];
    s.duv = (a[4] - w[1] * s.dv - w[2] * s.du - w[4] * s.point) / w[0];
    s.dvv = (a[5] - 2 * w[2] * s.dv - w[5] * s.point) / w[0];
    return s;
}

bool at_pole(Vec3d derivative, const SurfacePoint& s)
{
    constexpr double kPole = 1e-7;
    return dot(derivative, derivative) <= kPole * kPole * dot(s.duv, s.duv);
}

Vec3d upward_normal(const SurfacePoint& s)
{
    // Share of |du| |dv|: a smaller cross product is rounding.
    constexpr double kParallel = 1e-12;
    const Vec3d du = at_pole(s.du, s) ? s.duv : s.du;
    const Vec3d dv = at_pole(s.dv, s) ? s.duv : s.dv;
    const Vec3d n = cross(du, dv);
    const double square = dot(n, n);
    if (!(square > kParallel * kParallel * dot(du, du) * dot(dv, dv))) {
        return {};
    }
    const Vec3d unit = n / std::sqrt(square);
    if (std::abs(unit.z) > kParallel) {
        return unit.z < 0 ? -unit : unit;
    }
    const double leftward = unit.y * du.x - unit.x * du.y;
    return leftward < 0 ? -unit : unit;
}

std::vector<BezierPatch> bezier_patches(const Surface& surface)
{
    std::vector<BezierPatch> patches;
    const auto size_v = static_cast<std::size_t>(surface.size_v);
    for (const Strip& u :
         strips(control_rows_along_u(surface), surface.u_begin(), surface.u_end())) {
        const ControlRows along_v{surface.degree_v, surface.knots_v,
                                  static_cast<std::size_t>(surface.degree_u) + 1,
                                  transposed(u.points, size_v)};
        for (const Strip& v : strips(along_v, surface.v_begin(), surface.v_end())) {
            patches.push_back(make_patch(surface, u, v));
        }
    }
    return patches;
}

Curve isocurve_at_v(const Surface& surface, double v)
{
    const auto size_v = static_cast<std::size_t>(surface.size_v);
    const auto count = static_cast<std::size_t>(surface.size_u);
    return blended(surface, surface.knots_v, surface.degree_v, surface.size_v, v,
                   {surface.degree_u, surface.knots_u, 1, std::vector<HomogeneousPoint>(count)},
                   [size_v](std::size_t row, std::size_t k) { return k * size_v + row; });
}

Curve isocurve_at_u(const Surface& surface, double u)
{
    const auto size_v = static_cast<std::size_t>(surface.size_v);
    return blended(surface, surface.knots_u, surface.degree_u, surface.size_u, u,
                   {surface.degree_v, surface.knots_v, 1, std::vector<HomogeneousPoint>(size_v)},
                   [size_v](std::size_t row, std::size_t k) { return row * size_v + k; });
}

}  // namespace cusp::nurbs
