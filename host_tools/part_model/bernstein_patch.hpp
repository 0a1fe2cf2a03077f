// Polynomials over the unit square by their Bernstein coefficients: the range of the coefficients
// bounds the range of the values.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace cusp::part_model {

// Coefficient (i, j) of degree (p, q) stands at [i * (q + 1) + j].
struct BernsteinPatch {
    std::size_t p{};
    std::size_t q{};
    std::vector<double> c;

    static BernsteinPatch constant(double value) { return {0, 0, {value}}; }
};

BernsteinPatch operator*(const BernsteinPatch& a, const BernsteinPatch& b);
BernsteinPatch operator*(double k, BernsteinPatch a);
// Of any degrees; the sum has the higher ones.
BernsteinPatch operator+(const BernsteinPatch& a, const BernsteinPatch& b);
BernsteinPatch operator-(const BernsteinPatch& a, const BernsteinPatch& b);

// Derivatives by the local parameters.
BernsteinPatch derivative_s(const BernsteinPatch& a);
BernsteinPatch derivative_t(const BernsteinPatch& a);

double value_at(const BernsteinPatch& a, double s, double t);

// No value over the square is above (below), or farther from 0.
double upper_bound(const BernsteinPatch& a);
double lower_bound(const BernsteinPatch& a);
double magnitude_bound(const BernsteinPatch& a);

// The quarters of the square, each as a polynomial over the unit square.
std::array<BernsteinPatch, 4> quarters(const BernsteinPatch& a);

}  // namespace cusp::part_model
