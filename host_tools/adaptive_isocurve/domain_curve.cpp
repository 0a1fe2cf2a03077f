// Cubic Hermite pieces; the slope at a node is that of the parabola through it and its neighbours.
#include "host_tools/adaptive_isocurve/domain_curve.hpp"

#include <algorithm>
#include <cstddef>

namespace cusp::host {
namespace {

double chord_slope(const DomainCurve& c, std::size_t k)
{
    return (c.v[k + 1] - c.v[k]) / (c.u[k + 1] - c.u[k]);
}

double slope_at(const DomainCurve& c, std::size_t k)
{
    if (k == 0) {
        return chord_slope(c, 0);
    }
    if (k + 1 == c.u.size()) {
        return chord_slope(c, k - 1);
    }
    const double before = chord_slope(c, k - 1);
    const double after = chord_slope(c, k);
    const double h_before = c.u[k] - c.u[k - 1];
    const double h_after = c.u[k + 1] - c.u[k];
    return (before * h_after + after * h_before) / (h_before + h_after);
}

}  // namespace

double DomainCurve::v_at(double at) const
{
    const auto next = std::upper_bound(u.begin() + 1, u.end() - 1, at);
    const std::size_t k = static_cast<std::size_t>(next - u.begin()) - 1;
    const double h = u[k + 1] - u[k];
    const double t = std::clamp((at - u[k]) / h, 0.0, 1.0);
    if (v[k] == v[k + 1] && u.size() == 2) {
        return v[k];
    }
    const double m0 = slope_at(*this, k) * h;
    const double m1 = slope_at(*this, k + 1) * h;
    const double rise = v[k + 1] - v[k];
    return v[k] + t * (m0 + t * (3 * rise - 2 * m0 - m1 + t * (m0 + m1 - 2 * rise)));
}

std::vector<CurvePlace> places_at(const std::vector<DomainCurve>& curves, double u)
{
    std::vector<CurvePlace> out;
    for (const DomainCurve& curve : curves) {
        if (curve.u.front() > u || u > curve.u.back()) {
            continue;
        }
        if (curve.u.size() == 2) {
            out.push_back({curve.v_at(u), chord_slope(curve, 0)});
            continue;
        }
        const double step = 1e-5 * (curve.u.back() - curve.u.front());
        const double before = std::max(u - step, curve.u.front());
        const double after = std::min(u + step, curve.u.back());
        out.push_back({curve.v_at(u), (curve.v_at(after) - curve.v_at(before)) / (after - before)});
    }
    std::sort(out.begin(), out.end(),
              [](const CurvePlace& a, const CurvePlace& b) { return a.v < b.v; });
    return out;
}

DomainCurve isocurve(int surface, double v, double u_begin, double u_end)
{
    return {surface, {u_begin, u_end}, {v, v}};
}

}  // namespace cusp::host
