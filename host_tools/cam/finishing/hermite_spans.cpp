// Hermite spans; two steps of Newton's method find the parameter nearest to a dense point.
#include "host_tools/cam/finishing/hermite_spans.hpp"

#include <algorithm>

namespace cusp::finishing {

using nurbs::Curve;

namespace {

Vec3d bezier_at(const std::array<Vec3d, 4>& b, double t)
{
    const double s = 1 - t;
    return b[0] * (s * s * s) + b[1] * (3 * s * s * t) + b[2] * (3 * s * t * t) +
           b[3] * (t * t * t);
}

Vec3d bezier_slope(const std::array<Vec3d, 4>& b, double t)
{
    const double s = 1 - t;
    return (b[1] - b[0]) * (3 * s * s) + (b[2] - b[1]) * (6 * s * t) + (b[3] - b[2]) * (3 * t * t);
}

}  // namespace

Vec3d tangent_at(const Points& p, std::size_t k)
{
    Vec3d out;
    if (p.size() == 2) {
        out = p[1] - p[0];
    } else {
        const std::size_t m = std::clamp<std::size_t>(k, 1, p.size() - 2);
        const double before = std::max(1e-12, norm(p[m] - p[m - 1]));
        const double after = std::max(1e-12, norm(p[m + 1] - p[m]));
        const Vec3d first = (p[m] - p[m - 1]) / before;
        const Vec3d second = (p[m + 1] - p[m]) / after;
        const Vec3d bend = (second - first) / (before + after);
        const double at = k < m ? -before : k > m ? after : 0;
        out = (first * after + second * before) / (before + after) + bend * (2 * at);
    }
    return out / std::max(1e-300, norm(out));
}

HermiteSpan hermite_span(const Points& p,
                         const std::vector<double>& way,
                         const Points& tangent,
                         std::size_t from,
                         std::size_t to)
{
    const double length = way[to] - way[from];
    return {{p[from], p[from] + tangent[from] * (length / 3), p[to] - tangent[to] * (length / 3),
             p[to]},
            length};
}

bool hermite_span_fits(const HermiteSpan& span,
                       const Points& p,
                       const std::vector<double>& way,
                       std::size_t from,
                       std::size_t to,
                       double allowed)
{
    for (std::size_t k = from + 1; k < to; ++k) {
        double t = (way[k] - way[from]) / span.length;
        for (int turn = 0; turn < 2; ++turn) {
            const Vec3d slope = bezier_slope(span.bezier, t);
            t = std::clamp(t + dot(p[k] - bezier_at(span.bezier, t), slope) / dot(slope, slope),
                           0.0, 1.0);
        }
        if (norm(p[k] - bezier_at(span.bezier, t)) > allowed) {
            return false;
        }
    }
    return true;
}

Curve joined(const std::vector<HermiteSpan>& spans)
{
    Curve curve;
    curve.degree = 3;
    double way = 0;
    curve.knots.assign(4, 0.0);
    curve.points.push_back(spans.front().bezier[0]);
    for (std::size_t k = 0; k < spans.size(); ++k) {
        curve.points.push_back(spans[k].bezier[1]);
        curve.points.push_back(spans[k].bezier[2]);
        way += spans[k].length;
        curve.knots.insert(curve.knots.end(), k + 1 < spans.size() ? 2 : 4, way);
    }
    curve.points.push_back(spans.back().bezier[3]);
    curve.weights.assign(curve.points.size(), 1.0);
    return curve;
}

}  // namespace cusp::finishing
