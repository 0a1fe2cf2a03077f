// Curves: evaluation by basis functions, splitting by knot insertion.
#include <algorithm>
#include <cmath>

#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/nurbs/spline_basis.hpp"

namespace cusp::nurbs {
namespace {

std::vector<double> clamped_knots(int degree, double begin, double end)
{
    std::vector<double> knots(static_cast<std::size_t>(degree) + 1, begin);
    knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, end);
    return knots;
}

}  // namespace

Vec3d point_at(const Curve& curve, double u)
{
    SplineBasis basis;
    evaluate_basis(curve.knots, curve.degree, curve.points.size(), u, false, basis);
    Vec3d sum;
    double weight = 0;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(curve.degree); ++i) {
        const double share = basis.value[i] * curve.weights[basis.first + i];
        sum = sum + share * curve.points[basis.first + i];
        weight += share;
    }
    return sum / weight;
}

CurvePoint derivatives_at(const Curve& curve, double u)
{
    SplineBasis basis;
    evaluate_basis(curve.knots, curve.degree, curve.points.size(), u, true, basis);
    std::array<Vec3d, 3> sum{};
    std::array<double, 3> weight{};
    for (std::size_t i = 0; i <= static_cast<std::size_t>(curve.degree); ++i) {
        const double w = curve.weights[basis.first + i];
        const Vec3d& p = curve.points[basis.first + i];
        const std::array<double, 3> share{basis.value[i] * w, basis.first_derivative[i] * w,
                                          basis.second_derivative[i] * w};
        for (std::size_t k = 0; k < 3; ++k) {
            sum[k] = sum[k] + share[k] * p;
            weight[k] += share[k];
        }
    }
    CurvePoint at;
    at.point = sum[0] / weight[0];
    at.first = (sum[1] - weight[1] * at.point) / weight[0];
    at.second = (sum[2] - 2 * weight[1] * at.first - weight[2] * at.point) / weight[0];
    return at;
}

std::array<Curve, 2> split_at(const Curve& curve, double u)
{
    ControlRows rows = control_rows(curve);
    insert_to_degree(rows, u);
    const Curve whole = to_curve(rows);
    const auto lowest = std::lower_bound(whole.knots.begin(), whole.knots.end(), u);
    const auto k = lowest - whole.knots.begin();
    Curve left{curve.degree, {whole.knots.begin(), lowest + curve.degree}, {}, {}};
    left.knots.push_back(u);
    left.points.assign(whole.points.begin(), whole.points.begin() + k);
    left.weights.assign(whole.weights.begin(), whole.weights.begin() + k);
    Curve right{curve.degree, {u}, {}, {}};
    right.knots.insert(right.knots.end(), lowest, whole.knots.end());
    right.points.assign(whole.points.begin() + k - 1, whole.points.end());
    right.weights.assign(whole.weights.begin() + k - 1, whole.weights.end());
    return {left, right};
}

std::vector<Curve> bezier_pieces(const Curve& curve)
{
    ControlRows rows = control_rows(curve);
    insert_all_to_degree(rows);
    const Curve whole = to_curve(rows);
    std::vector<Curve> pieces;
    const auto p = static_cast<std::size_t>(curve.degree);
    for (std::size_t s = p; s < whole.points.size(); ++s) {
        const double begin = whole.knots[s];
        const double end = whole.knots[s + 1];
        if (!(begin < end) || begin < curve.domain_begin() || end > curve.domain_end()) {
            continue;
        }
        const auto first = static_cast<std::ptrdiff_t>(s - p);
        const auto last = static_cast<std::ptrdiff_t>(s) + 1;
        pieces.push_back({curve.degree,
                          clamped_knots(curve.degree, begin, end),
                          {whole.points.begin() + first, whole.points.begin() + last},
                          {whole.weights.begin() + first, whole.weights.begin() + last}});
    }
    return pieces;
}

Curve reversed(const Curve& curve)
{
    Curve back{curve.degree,
               {},
               {curve.points.rbegin(), curve.points.rend()},
               {curve.weights.rbegin(), curve.weights.rend()}};
    const double sum = curve.domain_begin() + curve.domain_end();
    for (auto knot = curve.knots.rbegin(); knot != curve.knots.rend(); ++knot) {
        back.knots.push_back(sum - *knot);
    }
    return back;
}

}  // namespace cusp::nurbs
