// Polynomials over the unit square in Bernstein form: the range of the coefficients bounds the
// range of the values.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace cusp::part_model {

// Degree (p, q); coefficient (i, j) is c[i * (q + 1) + j].
struct BernsteinPatch {
    std::size_t p{};
    std::size_t q{};
    std::vector<double> c;

    static BernsteinPatch constant(double value) { return {0, 0, {value}}; }
};

BernsteinPatch operator*(const BernsteinPatch& a, const BernsteinPatch& b);
BernsteinPatch operator*(double k, BernsteinPatch a);
// Degrees may differ; the result has the higher ones.
BernsteinPatch operator+(const BernsteinPatch& a, const BernsteinPatch& b);
BernsteinPatch operator-(const BernsteinPatch& a, const BernsteinPatch& b);

// Derivatives by the local parameters.
BernsteinPatch derivative_s(const BernsteinPatch& a);
BernsteinPatch derivative_t(const BernsteinPatch& a);

double value_at(const BernsteinPatch& a, double s, double t);

// Bounds of all values over the square, and of their absolute values.
double upper_bound(const BernsteinPatch& a);
double lower_bound(const BernsteinPatch& a);
double magnitude_bound(const BernsteinPatch& a);

// The quarters of the square, each as a polynomial over the unit square.
std::array<BernsteinPatch, 4> quarters(const BernsteinPatch& a);

}  // namespace cusp::part_model
