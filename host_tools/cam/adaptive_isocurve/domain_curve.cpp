// Cubic Hermite pieces; the slope at a node is that of the parabola through it and its neighbours.
#include "host_tools/cam/adaptive_isocurve/domain_curve.hpp"

#include <algorithm>
#include <cstddef>

namespace cusp::adaptive_isocurve {
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

// Nodes are usually equally spaced: the search starts where they would be.
std::size_t span_of(const std::vector<double>& u, double at)
{
    const double spans = static_cast<double>(u.size() - 1);
    const double even = std::clamp((at - u.front()) / (u.back() - u.front()), 0.0, 1.0) * spans;
    std::size_t k = std::min(static_cast<std::size_t>(even), u.size() - 2);
    while (k > 0 && at < u[k]) {
        --k;
    }
    while (k + 2 < u.size() && at >= u[k + 1]) {
        ++k;
    }
    return k;
}

}  // namespace

double DomainCurve::v_at(double at) const { return place_at(at).v; }

CurvePlace DomainCurve::place_at(double at) const
{
    if (u.size() == 2) {
        const double t = std::clamp((at - u[0]) / (u[1] - u[0]), 0.0, 1.0);
        return {v[0] + t * (v[1] - v[0]), chord_slope(*this, 0), nullptr};
    }
    const std::size_t k = span_of(u, at);
    const double h = u[k + 1] - u[k];
    const double t = std::clamp((at - u[k]) / h, 0.0, 1.0);
    const double m0 = slope_at(*this, k) * h;
    const double m1 = slope_at(*this, k + 1) * h;
    const double rise = v[k + 1] - v[k];
    const double bend = 3 * rise - 2 * m0 - m1;
    const double turn = m0 + m1 - 2 * rise;
    return {v[k] + t * (m0 + t * (bend + t * turn)), (m0 + t * (2 * bend + 3 * t * turn)) / h,
            nullptr};
}

std::vector<CurvePlace> places_at(const std::vector<DomainCurve>& curves, double u)
{
    std::vector<CurvePlace> out;
    for (const DomainCurve& curve : curves) {
        if (curve.u.front() <= u && u <= curve.u.back()) {
            out.push_back(curve.place_at(u));
            out.back().curve = &curve;
        }
    }
    std::sort(out.begin(), out.end(),
              [](const CurvePlace& a, const CurvePlace& b) { return a.v < b.v; });
    return out;
}

DomainCurve isocurve(int surface, double v, double u_begin, double u_end)
{
    return {surface, {u_begin, u_end}, {v, v}};
}

}  // namespace cusp::adaptive_isocurve
