#include "host_tools/job/import/trim_fit.hpp"

#include <array>
#include <cmath>

#include "host_tools/job/job/loop_shape.hpp"

namespace cusp::import {

using nurbs::Curve;

namespace {

class EdgeFit {
public:
    EdgeFit(const FaceEdge& edge, const UvOf& uv_of, double tolerance)
        : edge_{edge}, uv_of_{uv_of}, tolerance_{tolerance}
    {
    }

    Curve curve()
    {
        curve_ = {3, {}, {}, {}};
        add(edge_.from, edge_.to, at(edge_.from), at(edge_.to), 0);
        const auto spans = (curve_.points.size() - 1) / 3;
        for (std::size_t k = 0; k <= spans; ++k) {
            curve_.knots.insert(curve_.knots.end(), k == 0 || k == spans ? 4 : 3,
                                static_cast<double>(k));
        }
        curve_.weights.assign(curve_.points.size(), 1);
        return curve_;
    }

private:
    PointAndTangent at(double t) const { return uv_of_(edge_.at(t)); }

    void add(double from, double to, const PointAndTangent& a, const PointAndTangent& b, int depth)
    {
        constexpr int kMostHalvings = 12;
        const double third = (to - from) / 3;
        std::array<Vec3d, 4> span{a.point, a.point + a.tangent * third, b.point - b.tangent * third,
                                  b.point};
        const bool near = is_near(from, to, span);
        if (!near && depth == kMostHalvings) {
            // files have edges with a knot span of 1e-8 at the end, where the tangent is a jump's
            span[1] = a.point + (b.point - a.point) / 3.0;
            span[2] = b.point - (b.point - a.point) / 3.0;
        }
        if (near || depth == kMostHalvings) {
            if (curve_.points.empty()) {
                curve_.points.push_back(span[0]);
            }
            curve_.points.insert(curve_.points.end(), span.begin() + 1, span.end());
            return;
        }
        const double middle = 0.5 * (from + to);
        const PointAndTangent between = at(middle);
        add(from, middle, a, between, depth + 1);
        add(middle, to, between, b, depth + 1);
    }

    bool is_near(double from, double to, const std::array<Vec3d, 4>& span) const
    {
        constexpr int kLooks = 6;
        for (int k = 1; k < kLooks; ++k) {
            const double t = 1.0 * k / kLooks;
            const double r = 1 - t;
            const Vec3d fitted = span[0] * (r * r * r) + span[1] * (3 * r * r * t) +
                                 span[2] * (3 * r * t * t) + span[3] * (t * t * t);
            if (norm(fitted - at(from + (to - from) * t).point) > tolerance_) {
                return false;
            }
        }
        return true;
    }

    const FaceEdge& edge_;
    const UvOf& uv_of_;
    double tolerance_;
    Curve curve_;
};

std::vector<Curve> fitted_loop(const FaceLoop& loop, const UvOf& uv_of, double tolerance)
{
    std::vector<Curve> curves;
    for (const FaceEdge& edge : loop) {
        curves.push_back(EdgeFit{edge, uv_of, tolerance}.curve());
    }
    for (std::size_t k = 0; k < curves.size(); ++k) {
        curves[k].points.back() = curves[(k + 1) % curves.size()].points.front();
    }
    return curves;
}

bool has_width(const std::vector<Curve>& loop)
{
    constexpr double kChord = 1e-6;  // of (u, v), as the next
    constexpr double kLeastWidth = 2e-5;
    const std::vector<Vec2d> closed = job::loop_polyline(loop, kChord);
    double length = 0;
    for (std::size_t i = 1; i < closed.size(); ++i) {
        length += norm(closed[i] - closed[i - 1]);
    }
    return std::abs(job::signed_area(closed)) > kLeastWidth * length;
}

}  // namespace

std::vector<Curve> fitted_trims(const std::vector<FaceLoop>& loops,
                                const UvOf& uv_of,
                                double tolerance)
{
    std::vector<Curve> curves;
    for (const FaceLoop& loop : loops) {
        const std::vector<Curve> fitted = fitted_loop(loop, uv_of, tolerance);
        if (has_width(fitted)) {
            curves.insert(curves.end(), fitted.begin(), fitted.end());
        }
    }
    return curves;
}

}  // namespace cusp::import
