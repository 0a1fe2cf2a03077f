// Suh & Lee's curve offset after Tiller and Hanson: the control polygon is offset, knots are
// inserted until the deviation is below the tolerance. The product offsets biarcs instead; this is
// what they are compared with.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::test {

// Boehm's insertion of one knot inside the domain.
inline nurbs::Curve with_knot(const nurbs::Curve& curve, double u)
{
    const auto p = static_cast<std::size_t>(curve.degree);
    const auto span = static_cast<std::size_t>(
        std::upper_bound(curve.knots.begin(), curve.knots.end(), u) - curve.knots.begin() - 1);
    nurbs::Curve finer{curve.degree, curve.knots, {}, {}};
    finer.knots.insert(finer.knots.begin() + static_cast<std::ptrdiff_t>(span) + 1, u);
    for (std::size_t i = 0; i <= curve.points.size(); ++i) {
        double share = i + p <= span ? 1.0 : 0.0;
        if (i + p > span && i <= span) {
            share = (u - curve.knots[i]) / (curve.knots[i + p] - curve.knots[i]);
        }
        const std::size_t a = std::min(i, curve.points.size() - 1);
        const std::size_t b = i > 0 ? i - 1 : 0;
        const double w = share * curve.weights[a] + (1.0 - share) * curve.weights[b];
        finer.weights.push_back(w);
        finer.points.push_back((curve.points[a] * (share * curve.weights[a]) +
                                curve.points[b] * ((1.0 - share) * curve.weights[b])) /
                               w);
    }
    return finer;
}

// The control polygon moved by `distance` to its left, same knots and weights.
inline nurbs::Curve with_polygon_offset(const nurbs::Curve& curve, double distance)
{
    const auto plan = [&](std::size_t i) {
        return Vec2d{curve.points[i].x, curve.points[i].y};
    };
    nurbs::Curve moved = curve;
    const std::size_t last = curve.points.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
        const Vec2d before =
            i > 0 ? offset::unit(plan(i) - plan(i - 1)) : offset::unit(plan(1) - plan(0));
        const Vec2d after = i < last ? offset::unit(plan(i + 1) - plan(i)) : before;
        const Vec2d normals = offset::left_normal(before) + offset::left_normal(after);
        const Vec2d at = plan(i) + normals * (2.0 * distance / dot(normals, normals));
        moved.points[i] = {at.x, at.y, 0.0};
    }
    return moved;
}

struct TillerHanson {
    nurbs::Curve curve;
    int rounds;
};

// Knots are inserted in the middle of every span whose offset strays from C(t) + distance N(t) by
// more than `tolerance` (mm) at one of eight places.
inline TillerHanson tiller_hanson(nurbs::Curve source, double distance, double tolerance)
{
    constexpr int kRounds = 12;
    constexpr int kPlaces = 8;
    for (int round = 1;; ++round) {
        const nurbs::Curve moved = with_polygon_offset(source, distance);
        std::vector<double> too_wide;
        for (std::size_t k = 1; k < source.knots.size(); ++k) {
            const double from = source.knots[k - 1];
            const double width = source.knots[k] - from;
            double worst = 0.0;
            for (int i = 0; i < kPlaces && width > 0.0; ++i) {
                const double u = from + width * (i + 0.5) / kPlaces;
                const nurbs::CurvePoint c = derivatives_at(source, u);
                const Vec3d p = point_at(moved, u);
                const Vec2d normal = offset::left_normal(offset::unit({c.first.x, c.first.y}));
                const Vec2d off = Vec2d{p.x - c.point.x, p.y - c.point.y};
                // Along the normal: where on the offset a parameter lies does not matter.
                worst = std::max(worst, std::abs(dot(off, normal) - distance));
            }
            if (worst > tolerance) {
                too_wide.push_back(from + 0.5 * width);
            }
        }
        if (too_wide.empty() || round == kRounds) {
            return {moved, round};
        }
        for (const double u : too_wide) {
            source = with_knot(source, u);
        }
    }
}

}  // namespace cusp::test
