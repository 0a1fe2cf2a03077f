// Products of Bernstein polynomials, and their zeros by bisection.
#include "host_tools/cam/adaptive_isocurve/iso_distance.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::adaptive_isocurve {

using nurbs::Curve;

namespace {

using Coefficients = std::vector<double>;

double binomial(std::size_t n, std::size_t k)
{
    double out = 1;
    for (std::size_t i = 0; i < k; ++i) {
        out = out * static_cast<double>(n - i) / static_cast<double>(i + 1);
    }
    return out;
}

Coefficients product(const Coefficients& a, const Coefficients& b)
{
    const std::size_t m = a.size() - 1;
    const std::size_t n = b.size() - 1;
    Coefficients out(m + n + 1, 0.0);
    for (std::size_t i = 0; i <= m; ++i) {
        for (std::size_t j = 0; j <= n; ++j) {
            out[i + j] += binomial(m, i) * a[i] * binomial(n, j) * b[j];
        }
    }
    for (std::size_t k = 0; k < out.size(); ++k) {
        out[k] /= binomial(m + n, k);
    }
    return out;
}

void add(Coefficients& to, const Coefficients& from, double times)
{
    for (std::size_t k = 0; k < to.size(); ++k) {
        to[k] += times * from[k];
    }
}

Coefficients numerator(const Curve& piece, unsigned axis)
{
    Coefficients out;
    for (std::size_t k = 0; k < piece.points.size(); ++k) {
        out.push_back(piece.points[k][axis] * piece.weights[k]);
    }
    return out;
}

bool constant(const std::vector<double>& weights)
{
    const auto [low, high] = std::minmax_element(weights.begin(), weights.end());
    return *low == *high;
}

Coefficients polynomial_excess(const Curve& a, const Curve& b, double limit)
{
    Coefficients sum(2 * a.points.size() - 1, -limit * limit);
    for (unsigned axis = 0; axis < 3; ++axis) {
        Coefficients difference;
        for (std::size_t k = 0; k < a.points.size(); ++k) {
            difference.push_back(a.points[k][axis] - b.points[k][axis]);
        }
        add(sum, product(difference, difference), 1);
    }
    return sum;
}

Coefficients rational_excess(const Curve& a, const Curve& b, double limit)
{
    const Coefficients both = product(a.weights, b.weights);
    Coefficients sum(2 * both.size() - 1, 0.0);
    add(sum, product(both, both), -limit * limit);
    for (unsigned axis = 0; axis < 3; ++axis) {
        Coefficients difference = product(numerator(a, axis), b.weights);
        add(difference, product(numerator(b, axis), a.weights), -1);
        add(sum, product(difference, difference), 1);
    }
    return sum;
}

void halve(const Coefficients& from, Coefficients& lower, Coefficients& upper)
{
    Coefficients work = from;
    const std::size_t count = from.size();
    lower.resize(count);
    upper.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        lower[k] = work[0];
        upper[count - 1 - k] = work[count - 1 - k];
        for (std::size_t i = 0; i + 1 < count - k; ++i) {
            work[i] = 0.5 * (work[i] + work[i + 1]);
        }
    }
}

// Without a change of sign in its coefficients a polynomial has no zero.
void find_changes(
    const Coefficients& c, double begin, double end, double width, std::vector<double>& out)
{
    const auto positive = [](double v) {
        return v > 0;
    };
    const auto count = std::count_if(c.begin(), c.end(), positive);
    if (count == 0 || count == static_cast<std::ptrdiff_t>(c.size())) {
        return;
    }
    const double middle = 0.5 * (begin + end);
    if (end - begin < width) {
        if (positive(c.front()) != positive(c.back())) {
            out.push_back(middle);
        }
        return;
    }
    Coefficients lower;
    Coefficients upper;
    halve(c, lower, upper);
    find_changes(lower, begin, middle, width, out);
    if (positive(lower.back()) != positive(upper.front())) {
        out.push_back(middle);
    }
    find_changes(upper, middle, end, width, out);
}

bool positive_at(const ScalarSpline& spline, double u)
{
    const auto piece = std::find_if(spline.begin(), spline.end() - 1,
                                    [&](const BernsteinPiece& p) { return u <= p.end; });
    const double t = (u - piece->begin) / (piece->end - piece->begin);
    Coefficients work = piece->coefficients;
    for (std::size_t n = work.size(); n > 1; --n) {
        for (std::size_t i = 0; i + 1 < n; ++i) {
            work[i] = (1 - t) * work[i] + t * work[i + 1];
        }
    }
    return work[0] > 0;
}

}  // namespace

ScalarSpline distance_excess(const Curve& a, const Curve& b, double limit)
{
    const std::vector<Curve> pieces_a = bezier_pieces(a);
    const std::vector<Curve> pieces_b = bezier_pieces(b);
    const bool rational = !constant(a.weights) || !constant(b.weights);
    ScalarSpline out;
    for (std::size_t k = 0; k < pieces_a.size(); ++k) {
        out.push_back({pieces_a[k].domain_begin(), pieces_a[k].domain_end(),
                       rational ? rational_excess(pieces_a[k], pieces_b[k], limit)
                                : polynomial_excess(pieces_a[k], pieces_b[k], limit)});
    }
    return out;
}

std::vector<ParameterRange> sign_ranges(const ScalarSpline& spline, double begin, double end)
{
    std::vector<double> cuts;
    const double width = 1e-12 * (spline.back().end - spline.front().begin);
    for (const BernsteinPiece& piece : spline) {
        if (piece.end > begin && piece.begin < end) {
            find_changes(piece.coefficients, piece.begin, piece.end, width, cuts);
            cuts.push_back(piece.end);
        }
    }
    std::vector<ParameterRange> out;
    double from = begin;
    cuts.push_back(end);
    for (const double cut : cuts) {
        const double to = std::min(cut, end);
        if (to - from <= width) {
            continue;
        }
        const bool positive = positive_at(spline, 0.5 * (from + to));
        if (!out.empty() && out.back().positive == positive) {
            out.back().end = to;
        } else {
            out.push_back({from, to, positive});
        }
        from = to;
    }
    return out;
}

}  // namespace cusp::adaptive_isocurve
