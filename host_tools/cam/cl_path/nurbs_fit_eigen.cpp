// Normal equations of a clamped uniform cubic, banded, solved by Eigen's sparse Cholesky.
#include <algorithm>
#include <array>
#include <cmath>

#include "host_tools/cam/cl_path/cl_path.hpp"
#include "host_tools/cam/cl_path/nurbs_fit.hpp"

// Its sums in vectors have other bits on each machine.
#define EIGEN_DONT_VECTORIZE
// Eigen's headers do not compile without these warnings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wswitch-enum"
#include <Eigen/Dense>
#include <Eigen/Sparse>
#pragma GCC diagnostic pop

namespace cusp::cl_path {

using nurbs::Curve;
using offset::left_normal;

namespace {

using Row = std::array<double, 4>;

std::vector<double> uniform_knots(int count)
{
    std::vector<double> knots(4, 0.0);
    const int spans = count - 3;
    for (int i = 1; i < spans; ++i) {
        knots.push_back(static_cast<double>(i) / spans);
    }
    knots.insert(knots.end(), 4, 1.0);
    return knots;
}

// The four nonzero basis functions at t, and the index of the first (Cox-de Boor).
int basis_at(const std::vector<double>& knots, int count, double t, Row& basis)
{
    const int spans = count - 3;
    const int span = std::clamp(static_cast<int>(t * spans), 0, spans - 1) + 3;
    basis = {1.0, 0.0, 0.0, 0.0};
    for (int degree = 1; degree <= 3; ++degree) {
        double saved = 0.0;
        for (int r = 0; r < degree; ++r) {
            const double right = knots[static_cast<std::size_t>(span + r + 1)];
            const double left = knots[static_cast<std::size_t>(span + 1 - degree + r)];
            const auto at = static_cast<std::size_t>(r);
            const double share = basis[at] / (right - left);
            basis[at] = saved + (right - t) * share;
            saved = (t - left) * share;
        }
        basis[static_cast<std::size_t>(degree)] = saved;
    }
    return span - 3;
}

struct Samples {
    std::vector<Vec3d> points;
    std::vector<double> shares;  // of the chord length
};

Samples samples_of(const std::vector<Station>& stations, double middle)
{
    Samples samples;
    double length = 0.0;
    for (const Station& s : stations) {
        const Vec3d p{s.at.x, s.at.y, s.height + middle};
        length += samples.points.empty() ? 0.0 : norm(p - samples.points.back());
        samples.points.push_back(p);
        samples.shares.push_back(length);
    }
    for (double& share : samples.shares) {
        share /= length;
    }
    return samples;
}

std::optional<Curve> least_squares(const Samples& samples, int count)
{
    Curve curve{
        3, uniform_knots(count), {}, std::vector<double>(static_cast<std::size_t>(count), 1.0)};
    const int inner = count - 2;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(inner, 3);
    const Vec3d first = samples.points.front();
    const Vec3d last = samples.points.back();
    for (std::size_t k = 0; k < samples.points.size(); ++k) {
        Row basis;
        const int from = basis_at(curve.knots, count, samples.shares[k], basis);
        Vec3d rest = samples.points[k];
        for (int i = 0; i < 4; ++i) {
            const double b = basis[static_cast<std::size_t>(i)];
            rest = from + i == 0           ? rest - first * b
                   : from + i == count - 1 ? rest - last * b
                                           : rest;
        }
        for (int i = 0; i < 4; ++i) {
            const int row = from + i - 1;
            if (row < 0 || row >= inner) {
                continue;
            }
            const double b = basis[static_cast<std::size_t>(i)];
            for (int axis = 0; axis < 3; ++axis) {
                right(row, axis) += b * rest[static_cast<unsigned>(axis)];
            }
            for (int j = 0; j < 4; ++j) {
                const int column = from + j - 1;
                if (column >= 0 && column < inner) {
                    entries.emplace_back(row, column, b * basis[static_cast<std::size_t>(j)]);
                }
            }
        }
    }
    Eigen::SparseMatrix<double> normal(inner, inner);
    normal.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
    if (solver.info() != Eigen::Success) {
        return std::nullopt;
    }
    const Eigen::MatrixXd solved = solver.solve(right);
    curve.points.push_back(first);
    for (int i = 0; i < inner; ++i) {
        curve.points.push_back({solved(i, 0), solved(i, 1), solved(i, 2)});
    }
    curve.points.push_back(last);
    return curve;
}

// Between two stations a curve deviates from linear motion between its ends by at most an eighth of
// the squared step times its second derivative. That of a cubic is linear between knots, so the
// largest value is at a station or a knot.
bool stays_between(
    const Curve& curve, const Station& a, const Station& b, double from, double to, Vec3d tolerance)
{
    const double step = to - from;
    const Vec2d way = b.at - a.at;
    const Vec2d bent = left_normal(way) * (b.bend * std::sqrt(dot(way, way)));
    const auto strays = [&](double u) {
        const Vec3d second = derivatives_at(curve, u).second * (step * step);
        const Vec2d error = in_plan(second) - bent;
        return std::sqrt(dot(error, error)) > 8.0 * tolerance.x ||
               std::abs(second.z) > 8.0 * tolerance.z;
    };
    const double inside = 1e-6 * step;
    if (strays(from + inside) || strays(to - inside)) {
        return false;
    }
    const auto last = std::lower_bound(curve.knots.begin(), curve.knots.end(), to);
    return std::none_of(std::upper_bound(curve.knots.begin(), last, from), last, [&](double knot) {
        return strays(knot - inside) || strays(knot + inside);
    });
}

bool passes(const Curve& curve,
            const std::vector<Station>& stations,
            const Samples& samples,
            const StationBand& band)
{
    for (std::size_t k = 0; k < stations.size(); ++k) {
        const Vec3d p = point_at(curve, samples.shares[k]);
        const Vec2d error = in_plan(p) - stations[k].at;
        const double over = p.z - stations[k].height - dot(stations[k].gradient, error);
        if (!(dot(error, error) <= band.plan_tolerance * band.plan_tolerance) ||
            !(over >= band.low) || !(over <= band.high)) {
            return false;
        }
    }
    // Part of the tolerance is reserved for the curve between stations.
    const Vec3d between{0.16 * band.plan_tolerance, 0.16 * band.plan_tolerance,
                        0.3 * (band.high - band.low)};
    for (std::size_t k = 1; k < stations.size(); ++k) {
        if (!stays_between(curve, stations[k - 1], stations[k], samples.shares[k - 1],
                           samples.shares[k], between)) {
            return false;
        }
    }
    return true;
}

}  // namespace

bool nurbs_fit_available() { return true; }

std::optional<Curve> fit_cubic(const std::vector<Station>& stations, const StationBand& band)
{
    const Samples samples = samples_of(stations, band.middle());
    const int max_count = static_cast<int>(stations.size()) / 2;
    const auto fitted = [&](int count) -> std::optional<Curve> {
        auto curve = least_squares(samples, count);
        const bool good = curve && passes(*curve, stations, samples, band);
        return good ? curve : std::nullopt;
    };
    std::optional<Curve> best;
    int bad = 3;
    int count = 4;
    for (; count <= max_count && !best; count *= 2) {
        best = fitted(count);
        bad = best ? bad : count;
    }
    int good = count / 2;
    while (best && good - bad > 1 + good / 16) {
        const int middle = (good + bad) / 2;
        if (auto curve = fitted(middle)) {
            best = std::move(curve);
            good = middle;
        } else {
            bad = middle;
        }
    }
    return best;
}

}  // namespace cusp::cl_path
