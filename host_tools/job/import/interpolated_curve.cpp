// Slopes at the points by a tridiagonal system; control points by blossoming the pieces between them.
#include "host_tools/job/import/interpolated_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace cusp::import {
namespace {

using Points = std::vector<Vec3d>;

// below[i] x[i-1] + middle[i] x[i] + above[i] x[i+1] = right[i]; diagonally dominant.
struct Tridiagonal {
    std::vector<double> below, middle, above;
    Points right;

    explicit Tridiagonal(std::size_t size) : below(size), middle(size), above(size), right(size) {}

    Points solved() const
    {
        const std::size_t n = middle.size();
        std::vector<double> pivot = middle;
        Points x = right;
        for (std::size_t i = 1; i < n; ++i) {
            const double factor = below[i] / pivot[i - 1];
            pivot[i] -= factor * above[i - 1];
            x[i] = x[i] - factor * x[i - 1];
        }
        x[n - 1] = 1 / pivot[n - 1] * x[n - 1];
        for (std::size_t i = n - 1; i-- > 0;) {
            x[i] = 1 / pivot[i] * (x[i] - above[i] * x[i + 1]);
        }
        return x;
    }
};

class Spline {
public:
    explicit Spline(Points points) : points_{std::move(points)}
    {
        for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
            steps_.push_back(norm(points_[i + 1] - points_[i]));
            rises_.push_back(1 / steps_[i] * (points_[i + 1] - points_[i]));
        }
    }

    void take_open_slopes(const EndTangents& tangents)
    {
        const std::size_t n = steps_.size();
        Tridiagonal system{n + 1};
        set_inner(system);
        const auto set_end = [&](std::size_t row, double& beside, std::size_t piece,
                                 const std::optional<Vec3d>& tangent) {
            const bool given = tangent && norm(*tangent) > 0;
            system.middle[row] = given ? 1 : 2;
            beside = given ? 0 : 1;
            system.right[row] = given ? 1 / norm(*tangent) * *tangent : 3 * rises_[piece];
        };
        set_end(0, system.above[0], 0, tangents.first);
        set_end(n, system.below[n], n - 1, tangents.last);
        slopes_ = system.solved();
    }

    // Sherman and Morrison: the two corners of the cyclic system are a change of rank one.
    void take_closed_slopes()
    {
        const std::size_t n = steps_.size();
        if (n < 3) {  // there and back
            slopes_.assign(n + 1, Vec3d{});
            return;
        }
        Tridiagonal system{n + 1};
        set_inner(system);
        set_row(system, 0, n - 1, 0);
        const double corner = system.below[0];  // of row 0 in the last column
        const double other = system.above[n - 1];
        for (auto* row : {&system.below, &system.middle, &system.above}) {
            row->resize(n);
        }
        system.right.resize(n);
        const double gamma = -system.middle[0];
        system.middle[0] -= gamma;
        system.middle[n - 1] -= corner * other / gamma;
        const Points x = system.solved();
        Tridiagonal change = system;
        change.right.assign(n, Vec3d{});
        change.right[0] = {gamma, gamma, gamma};
        change.right[n - 1] = {other, other, other};
        const Points z = change.solved();
        const double share = corner / gamma;
        const double below = 1 + z[0].x + share * z[n - 1].x;
        const Vec3d factor = 1 / below * (x[0] + share * x[n - 1]);
        slopes_.clear();
        for (std::size_t i = 0; i < n; ++i) {
            slopes_.push_back(x[i] - z[i].x * factor);
        }
        slopes_.push_back(slopes_[0]);
    }

    nurbs::Curve curve() const
    {
        std::vector<double> at{0};
        for (const double step : steps_) {
            at.push_back(at.back() + step);
        }
        nurbs::Curve curve;
        curve.degree = 3;
        curve.knots.assign(3, at.front());
        curve.knots.insert(curve.knots.end(), at.begin(), at.end());
        curve.knots.insert(curve.knots.end(), 3, at.back());
        for (std::size_t k = 0; k + 4 < curve.knots.size(); ++k) {
            // the knot in the middle begins a piece that the control point acts on
            const std::size_t piece = std::clamp<std::size_t>(k + 2, 3, steps_.size() + 2) - 3;
            curve.points.push_back(blossom(
                piece, at[piece], {curve.knots[k + 1], curve.knots[k + 2], curve.knots[k + 3]}));
        }
        curve.points.front() = points_.front();
        curve.points.back() = points_.back();
        curve.weights.assign(curve.points.size(), 1.0);
        return curve;
    }

private:
    // The curvature is continuous at a point between two pieces.
    void set_row(Tridiagonal& system, std::size_t row, std::size_t before, std::size_t after) const
    {
        const double a = 1 / steps_[before];
        const double b = 1 / steps_[after];
        system.below[row] = a;
        system.middle[row] = 2 * (a + b);
        system.above[row] = b;
        system.right[row] = 3 * (a * rises_[before] + b * rises_[after]);
    }
    void set_inner(Tridiagonal& system) const
    {
        for (std::size_t i = 1; i < steps_.size(); ++i) {
            set_row(system, i, i - 1, i);
        }
    }

    // The symmetric form of a piece at three parameters, by de Casteljau.
    Vec3d blossom(std::size_t piece, double begin, const std::array<double, 3>& at) const
    {
        const double step = steps_[piece];
        std::array<Vec3d, 4> b{points_[piece], points_[piece] + step / 3 * slopes_[piece],
                               points_[piece + 1] - step / 3 * slopes_[piece + 1],
                               points_[piece + 1]};
        for (std::size_t level = 0; level < 3; ++level) {
            const double t = (at[level] - begin) / step;
            for (std::size_t i = 0; i + level < 3; ++i) {
                b[i] = b[i] + t * (b[i + 1] - b[i]);
            }
        }
        return b[0];
    }

    Points points_;
    std::vector<double> steps_;
    Points rises_;  // of the chords, per unit of length
    Points slopes_;
};

}  // namespace

nurbs::Curve interpolated_curve(std::vector<Vec3d> points, bool closed, const EndTangents& tangents)
{
    constexpr double kSamePlace = 1e-9;  // mm
    points.erase(std::unique(points.begin(), points.end(),
                             [](Vec3d a, Vec3d b) { return norm(b - a) <= kSamePlace; }),
                 points.end());
    if (closed) {
        if (points.size() > 1 && norm(points.back() - points.front()) <= kSamePlace) {
            points.pop_back();
        }
        points.push_back(points.front());
    }
    Spline spline{std::move(points)};
    if (closed) {
        spline.take_closed_slopes();
    } else {
        spline.take_open_slopes(tangents);
    }
    return spline.curve();
}

}  // namespace cusp::import
