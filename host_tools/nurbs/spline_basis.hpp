// The B-spline functions that are not zero at a parameter, with derivatives, without allocation.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace cusp::nurbs {

// Curves and surfaces of a higher degree are refused by the reader.
inline constexpr int kMaximumDegree = 25;

// The degree + 1 functions at u belong to control points first, first + 1, ...
struct SplineBasis {
    using Row = std::array<double, kMaximumDegree + 1>;
    std::size_t first{};
    Row value;  // degree + 1 numbers are set in each row
    Row first_derivative;
    Row second_derivative;
};

// The span of the domain in which u lies: knots[span] <= u < knots[span + 1]; the last one at the
// domain's end.
//
// count  number of control points
std::size_t span_at(const std::vector<double>& knots, int degree, std::size_t count, double u);

// Fills `value` and, where `derivatives` says so, both rows of derivatives. u is clamped to the
// domain.
//
// Source: Piegl and Tiller, The NURBS Book, A2.2; derivatives by (2.7), applied twice.
void evaluate_basis(const std::vector<double>& knots,
                    int degree,
                    std::size_t count,
                    double u,
                    bool derivatives,
                    SplineBasis& basis);

}  // namespace cusp::nurbs
