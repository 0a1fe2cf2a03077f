// The nonzero B-spline functions at a parameter, with derivatives, without allocation.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace cusp::nurbs {

// The readers refuse curves and surfaces of a higher degree.
inline constexpr int kMaximumDegree = 25;

// The degree + 1 functions at u belong to control points first, first + 1, ...
struct SplineBasis {
    using Row = std::array<double, kMaximumDegree + 1>;
    std::size_t first{};
    Row value;  // degree + 1 numbers are set in each row
    Row first_derivative;
    Row second_derivative;
};

// The span of the domain that holds u: knots[span] <= u < knots[span + 1]; at the end of the domain
// the last one.
//
// count  number of control points
std::size_t span_at(const std::vector<double>& knots, int degree, std::size_t count, double u);

// Fills `value` and, if `derivatives`, both rows of derivatives. u is clamped to the domain.
//
// Source: Piegl and Tiller, The NURBS Book, A2.2; derivatives by (2.7), applied twice.
void evaluate_basis(const std::vector<double>& knots,
                    int degree,
                    std::size_t count,
                    double u,
                    bool derivatives,
                    SplineBasis& basis);

}  // namespace cusp::nurbs
