// Products of coefficients scaled by binomials; halves by de Casteljau's algorithm.
#include "host_tools/geometry/part_model/bernstein_patch.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::part_model {
namespace {

std::vector<double> binomials(std::size_t n)
{
    std::vector<double> out{1.0};
    for (std::size_t k = 1; k <= n; ++k) {
        out.push_back(out.back() * static_cast<double>(n - k + 1) / static_cast<double>(k));
    }
    return out;
}

// Coefficients times their binomials (or divided, `back`): those of powers of s / (1 - s) and
// t / (1 - t).
BernsteinPatch scaled(BernsteinPatch a, bool back)
{
    const std::vector<double> u = binomials(a.p);
    const std::vector<double> v = binomials(a.q);
    for (std::size_t i = 0; i <= a.p; ++i) {
        for (std::size_t j = 0; j <= a.q; ++j) {
            const double factor = u[i] * v[j];
            a.c[i * (a.q + 1) + j] *= back ? 1.0 / factor : factor;
        }
    }
    return a;
}

BernsteinPatch raised(const BernsteinPatch& a, std::size_t p, std::size_t q)
{
    if (a.p == p && a.q == q) {
        return a;
    }
    const std::size_t count = (p - a.p + 1) * (q - a.q + 1);
    return a * BernsteinPatch{p - a.p, q - a.q, std::vector<double>(count, 1.0)};
}

BernsteinPatch combined(const BernsteinPatch& a, const BernsteinPatch& b, double sign)
{
    const std::size_t p = std::max(a.p, b.p);
    const std::size_t q = std::max(a.q, b.q);
    BernsteinPatch out = raised(a, p, q);
    const BernsteinPatch other = raised(b, p, q);
    for (std::size_t k = 0; k < out.c.size(); ++k) {
        out.c[k] += sign * other.c[k];
    }
    return out;
}

BernsteinPatch transposed(const BernsteinPatch& a)
{
    BernsteinPatch out{a.q, a.p, std::vector<double>(a.c.size())};
    for (std::size_t i = 0; i <= a.p; ++i) {
        for (std::size_t j = 0; j <= a.q; ++j) {
            out.c[j * (a.p + 1) + i] = a.c[i * (a.q + 1) + j];
        }
    }
    return out;
}

// Both halves along s.
std::array<BernsteinPatch, 2> halves(const BernsteinPatch& a)
{
    std::array<BernsteinPatch, 2> out{a, a};
    const std::size_t row = a.q + 1;
    std::vector<double> work = a.c;
    for (std::size_t level = 0; level <= a.p; ++level) {
        const std::size_t last = a.p - level;
        for (std::size_t j = 0; j < row; ++j) {
            out[0].c[level * row + j] = work[j];
            out[1].c[last * row + j] = work[last * row + j];
        }
        for (std::size_t k = 0; k < last * row; ++k) {
            work[k] = 0.5 * (work[k] + work[k + row]);
        }
    }
    return out;
}

}  // namespace

BernsteinPatch operator*(const BernsteinPatch& a, const BernsteinPatch& b)
{
    const BernsteinPatch x = scaled(a, false);
    const BernsteinPatch y = scaled(b, false);
    BernsteinPatch out{a.p + b.p, a.q + b.q, {}};
    out.c.assign((out.p + 1) * (out.q + 1), 0.0);
    for (std::size_t i = 0; i <= a.p; ++i) {
        for (std::size_t j = 0; j <= a.q; ++j) {
            const double factor = x.c[i * (a.q + 1) + j];
            for (std::size_t k = 0; k <= b.p; ++k) {
                const std::size_t to = (i + k) * (out.q + 1) + j;
                for (std::size_t m = 0; m <= b.q; ++m) {
                    out.c[to + m] += factor * y.c[k * (b.q + 1) + m];
                }
            }
        }
    }
    return scaled(std::move(out), true);
}

BernsteinPatch operator*(double k, BernsteinPatch a)
{
    for (double& c : a.c) {
        c *= k;
    }
    return a;
}

BernsteinPatch operator+(const BernsteinPatch& a, const BernsteinPatch& b)
{
    return combined(a, b, 1.0);
}

BernsteinPatch operator-(const BernsteinPatch& a, const BernsteinPatch& b)
{
    return combined(a, b, -1.0);
}

BernsteinPatch derivative_s(const BernsteinPatch& a)
{
    if (a.p == 0) {
        return {0, a.q, std::vector<double>(a.q + 1, 0.0)};
    }
    BernsteinPatch out{a.p - 1, a.q, {}};
    for (std::size_t k = 0; k < a.p * (a.q + 1); ++k) {
        out.c.push_back(static_cast<double>(a.p) * (a.c[k + a.q + 1] - a.c[k]));
    }
    return out;
}

BernsteinPatch derivative_t(const BernsteinPatch& a)
{
    return transposed(derivative_s(transposed(a)));
}

double value_at(const BernsteinPatch& a, double s, double t)
{
    const auto along = [](std::vector<double> c, double x) {
        for (std::size_t n = c.size(); n > 1; --n) {
            for (std::size_t k = 0; k + 1 < n; ++k) {
                c[k] = c[k] * (1.0 - x) + c[k + 1] * x;
            }
        }
        return c.front();
    };
    std::vector<double> column;
    for (std::size_t i = 0; i <= a.p; ++i) {
        const auto row = a.c.begin() + static_cast<std::ptrdiff_t>(i * (a.q + 1));
        column.push_back(along({row, row + static_cast<std::ptrdiff_t>(a.q) + 1}, t));
    }
    return along(std::move(column), s);
}

double upper_bound(const BernsteinPatch& a) { return *std::max_element(a.c.begin(), a.c.end()); }

double lower_bound(const BernsteinPatch& a) { return *std::min_element(a.c.begin(), a.c.end()); }

double magnitude_bound(const BernsteinPatch& a)
{
    return std::max(std::abs(upper_bound(a)), std::abs(lower_bound(a)));
}

std::array<BernsteinPatch, 4> quarters(const BernsteinPatch& a)
{
    std::array<BernsteinPatch, 4> out;
    std::size_t k = 0;
    for (const BernsteinPatch& half : halves(a)) {
        for (const BernsteinPatch& quarter : halves(transposed(half))) {
            out[k++] = transposed(quarter);
        }
    }
    return out;
}

}  // namespace cusp::part_model
