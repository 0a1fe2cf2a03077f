// Lines, arcs and bulges as NURBS; what drawing programs write as one spline.
#include "host_tools/job/import/drawn_shapes.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::import {

using nurbs::Curve;

std::vector<Curve> curves_of(const std::vector<DrawingPath>& paths)
{
    std::vector<Curve> all;
    for (const DrawingPath& path : paths) {
        all.insert(all.end(), path.curves.begin(), path.curves.end());
    }
    return all;
}

Curve line_curve(Vec2d a, Vec2d b)
{
    return {1, {0, 0, 1, 1}, {{a.x, a.y, 0}, {b.x, b.y, 0}}, {1, 1}};
}

Curve bezier_curve(const std::vector<Vec2d>& points)
{
    const auto degree = static_cast<int>(points.size()) - 1;
    Curve curve{degree, {}, {}, std::vector<double>(points.size(), 1)};
    curve.knots.assign(points.size(), 0);
    curve.knots.insert(curve.knots.end(), points.size(), 1);
    for (const Vec2d p : points) {
        curve.points.push_back({p.x, p.y, 0});
    }
    return curve;
}

Curve bulged_curve(Vec2d from, Vec2d to, double bulge)
{
    constexpr double kStraight = 1e-9;
    if (!(std::abs(bulge) > kStraight)) {
        return line_curve(from, to);
    }
    const Vec2d chord = to - from;
    // the centre lies to the left of the chord for a counter-clockwise arc below a half turn
    const double offset = (1 - bulge * bulge) / (4 * bulge);
    const Vec2d centre = 0.5 * (from + to) + offset * Vec2d{-chord.y, chord.x};
    const Vec2d spoke = from - centre;
    Curve curve = arc_curve(centre, norm(spoke), elementary::atan2(spoke.y, spoke.x),
                            4 * elementary::atan(bulge));
    curve.points.front() = {from.x, from.y, 0};
    curve.points.back() = {to.x, to.y, 0};
    return curve;
}

Curve arc_curve(Vec2d centre, double radius, double start, double sweep)
{
    constexpr double kMostPerPiece = kPi / 2 + 1e-9;
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / kMostPerPiece)));
    const double step = sweep / pieces;
    const double middle_weight = elementary::cos(step / 2);
    const auto on_circle = [&](double angle, double r) {
        return Vec3d{centre.x + r * elementary::cos(angle), centre.y + r * elementary::sin(angle),
                     0};
    };
    Curve curve{2, {0, 0, 0}, {on_circle(start, radius)}, {1}};
    for (int i = 0; i < pieces; ++i) {
        const double begin = start + i * step;
        curve.points.push_back(on_circle(begin + step / 2, radius / middle_weight));
        curve.points.push_back(on_circle(begin + step, radius));
        curve.weights.push_back(middle_weight);
        curve.weights.push_back(1);
        curve.knots.insert(curve.knots.end(), 2, i + 1);
    }
    curve.knots.push_back(pieces);
    return curve;
}

std::vector<Curve> parts_of(const Curve& curve)
{
    const std::size_t order = static_cast<std::size_t>(curve.degree) + 1;
    const std::size_t count = curve.points.size();
    if (curve.knots.size() != count + order || curve.weights.size() != count) {
        return {curve};
    }
    std::vector<Curve> parts;
    std::size_t begin = 0;
    for (std::size_t end = 1; end <= count; ++end) {
        const bool breaks = end < count && curve.knots[end] > curve.knots[end - 1] &&
                            curve.knots[end] == curve.knots[end + order - 1];
        if (!breaks && end < count) {
            continue;
        }
        const auto from = static_cast<std::ptrdiff_t>(begin);
        const auto to = static_cast<std::ptrdiff_t>(end);
        parts.push_back({curve.degree,
                         {curve.knots.begin() + from, curve.knots.begin() + to + curve.degree + 1},
                         {curve.points.begin() + from, curve.points.begin() + to},
                         {curve.weights.begin() + from, curve.weights.begin() + to}});
        begin = end;
    }
    return parts;
}

}  // namespace cusp::import
