// Recognizes lines and circles by samples; fits other curves by biarcs with bisection.
#include "host_tools/geometry/offset/contour_fit.hpp"

#include <algorithm>
#include <optional>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::offset {

using nurbs::Curve;
using nurbs::CurvePoint;

namespace {

constexpr double kExact = 1e-8;
constexpr int kSamples = 12;
constexpr int kMostHalvings = 24;

struct CurveStation {
    Vec2d point;
    Vec2d tangent;
};

// If the derivative vanishes (coincident control points), the tangent is that a little inside.
CurveStation station(const Curve& curve, double u, double toward)
{
    CurvePoint at = derivatives_at(curve, u);
    Vec2d tangent = in_plan(at.first);
    for (double share = 1e-9; dot(tangent, tangent) < 1e-18 && share < 1e-2; share *= 10.0) {
        tangent = in_plan(derivatives_at(curve, u + (toward - u) * share).first);
    }
    return {in_plan(at.point), unit(tangent)};
}

std::vector<Vec2d> samples(const Curve& curve)
{
    std::vector<Vec2d> points;
    const double u0 = curve.domain_begin();
    const double u1 = curve.domain_end();
    const int n = kSamples * static_cast<int>(curve.points.size());
    for (int i = 0; i <= n; ++i) {
        points.push_back(in_plan(point_at(curve, u0 + (u1 - u0) * i / n)));
    }
    return points;
}

bool is_line(const std::vector<Vec2d>& points)
{
    const Vec2d chord = points.back() - points.front();
    const double size = elementary::hypot(chord.x, chord.y);
    double along = 0.0;
    for (const Vec2d p : points) {
        const Vec2d arm = p - points.front();
        const double here = dot(arm, chord);
        if (std::abs(cross(chord, arm)) > kExact * size || here < along - kExact * size) {
            return false;
        }
        along = std::max(along, here);
    }
    return size > kExact;
}

// The circle through three points.
std::optional<Vec2d> centre_of(Vec2d a, Vec2d b, Vec2d c)
{
    const Vec2d u = b - a;
    const Vec2d v = c - a;
    const double twice = 2.0 * cross(u, v);
    if (std::abs(twice) < 1e-12 * (dot(u, u) + dot(v, v))) {
        return std::nullopt;
    }
    const Vec2d w = v * dot(u, u) - u * dot(v, v);
    return a + Vec2d{w.y, -w.x} * (1.0 / twice);
}

// Arcs through the samples if all lie on one circle; else empty.
std::vector<Edge> as_arcs(const std::vector<Vec2d>& points)
{
    const std::size_t n = points.size() - 1;
    const auto centre = centre_of(points.front(), points[n / 3], points[2 * n / 3]);
    if (!centre) {
        return {};
    }
    const double radius = distance(*centre, points.front());
    const int turn = cross(points.front() - *centre, points[1] - *centre) > 0.0 ? 1 : -1;
    std::vector<std::size_t> stops{0};
    double swept = 0.0;
    for (std::size_t i = 1; i <= n; ++i) {
        if (std::abs(distance(*centre, points[i]) - radius) > kExact) {
            return {};
        }
        const Vec2d a = points[i - 1] - *centre;
        const Vec2d b = points[i] - *centre;
        const double step = elementary::atan2(cross(a, b), dot(a, b)) * turn;
        if (step < 0.0) {
            return {};
        }
        swept += step;
        if (swept > 1.6 && i < n) {
            stops.push_back(i);
            swept = 0.0;
        }
    }
    stops.push_back(n);
    std::vector<Edge> edges;
    for (std::size_t k = 1; k < stops.size(); ++k) {
        edges.push_back({points[stops[k - 1]], points[stops[k]], *centre, radius, turn});
    }
    return edges;
}

// The arc from a point with a tangent to another point.
Edge arc_through(Vec2d start, Vec2d tangent, Vec2d end)
{
    const Vec2d chord = end - start;
    const double across = dot(left_normal(tangent), chord);
    const double square = dot(chord, chord);
    if (std::abs(across) < 1e-12 * square || std::abs(across) < 1e-14) {
        return line_edge(start, end);
    }
    const double signed_radius = square / (2.0 * across);
    const Vec2d centre = start + left_normal(tangent) * signed_radius;
    return {start, end, centre, std::abs(signed_radius), signed_radius > 0.0 ? 1 : -1};
}

// The biarc with equal tangent lengths (Bolton 1975); no value where the ends allow none.
std::optional<std::array<Edge, 2>> biarc(const CurveStation& a, const CurveStation& b)
{
    const Vec2d chord = b.point - a.point;
    const Vec2d sum = a.tangent + b.tangent;
    const double bend = 2.0 * (1.0 - dot(a.tangent, b.tangent));
    const double forward = dot(chord, sum);
    if (dot(a.tangent, chord) <= 0.0 || dot(b.tangent, chord) <= 0.0) {
        return std::nullopt;
    }
    // bend d^2 + 2 forward d - chord^2 = 0, in the form that stays exact for bend near 0.
    const double root = std::sqrt(forward * forward + bend * dot(chord, chord));
    const double reach = dot(chord, chord) / (forward + root);
    const Vec2d joint = (a.point + b.point + (a.tangent - b.tangent) * reach) * 0.5;
    const Edge second = reversed(arc_through(b.point, b.tangent * -1.0, joint));
    return std::array<Edge, 2>{arc_through(a.point, a.tangent, joint), second};
}

bool fits(
    const Curve& curve, double u0, double u1, const std::array<Edge, 2>& pair, double tolerance)
{
    for (int i = 1; i < kSamples; ++i) {
        const Vec2d p = in_plan(point_at(curve, u0 + (u1 - u0) * i / kSamples));
        if (std::min(distance_to(pair[0], p), distance_to(pair[1], p)) > tolerance) {
            return false;
        }
    }
    return true;
}

void fit_piece(const Curve& curve,
               double u0,
               double u1,
               double tolerance,
               int halvings,
               std::vector<Edge>& edges)
{
    const CurveStation a = station(curve, u0, u1);
    const CurveStation b = station(curve, u1, u0);
    if (distance(a.point, b.point) < kExact && halvings > 2) {
        return;
    }
    if (dot(a.tangent, b.tangent) > 0.2) {
        const auto pair = biarc(a, b);
        // 0.7: samples miss the point of largest deviation.
        if (pair && fits(curve, u0, u1, *pair, 0.7 * tolerance)) {
            edges.insert(edges.end(), pair->begin(), pair->end());
            return;
        }
    }
    if (halvings == kMostHalvings) {
        edges.push_back(line_edge(a.point, b.point));
        return;
    }
    const double middle = 0.5 * (u0 + u1);
    fit_piece(curve, u0, middle, tolerance, halvings + 1, edges);
    fit_piece(curve, middle, u1, tolerance, halvings + 1, edges);
}

// Ends that differ by rounding are moved together; wider gaps become lines, so that arcs remain on
// their circles.
Contour closed_up(const Contour& chain)
{
    constexpr double kRounding = 1e-7;
    Contour contour;
    for (std::size_t i = 0; i < chain.size(); ++i) {
        contour.push_back(chain[i]);
        const Vec2d next = chain[(i + 1) % chain.size()].start;
        if (distance(chain[i].end, next) > kRounding) {
            contour.push_back(line_edge(chain[i].end, next));
        } else {
            contour.back().end = next;
        }
    }
    return contour;
}

}  // namespace

std::optional<std::array<Edge, 2>> biarc_between(Vec2d from,
                                                 Vec2d leaving,
                                                 Vec2d to,
                                                 Vec2d arriving)
{
    return biarc({from, leaving}, {to, arriving});
}

std::vector<Edge> fit_edges(const Curve& curve, double tolerance)
{
    std::vector<Edge> edges;
    for (const Curve& piece : bezier_pieces(curve)) {
        const std::vector<Vec2d> points = samples(piece);
        if (is_line(points)) {
            edges.push_back(line_edge(points.front(), points.back()));
            continue;
        }
        const std::vector<Edge> arcs = as_arcs(points);
        if (!arcs.empty()) {
            edges.insert(edges.end(), arcs.begin(), arcs.end());
            continue;
        }
        fit_piece(piece, piece.domain_begin(), piece.domain_end(), tolerance, 0, edges);
    }
    return edges;
}

Contour fit_contour(const std::vector<Curve>& loop, double tolerance)
{
    Contour contour;
    for (const Curve& curve : loop) {
        const std::vector<Edge> edges = fit_edges(curve, tolerance);
        contour.insert(contour.end(), edges.begin(), edges.end());
    }
    return closed_up(contour);
}

}  // namespace cusp::offset
