// The distance between two isocurves at equal parameters, as a spline whose sign shows where they
// are too far apart.
#pragma once

#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::adaptive_isocurve {

// A polynomial on [begin, end] by its Bernstein coefficients.
struct BernsteinPiece {
    double begin{};
    double end{};
    std::vector<double> coefficients;
};

// A piecewise polynomial, its pieces in order.
using ScalarSpline = std::vector<BernsteinPiece>;

// |a(u) - b(u)|^2 - limit^2; if weights are not constant, times the square of both. Positive where
// the curves are farther apart than `limit`.
// Precondition: the curves have equal degrees and knots, as isocurves of one surface have.
//
// Source: Elber & Cohen 1993, equation (1); products as in [10] there.
ScalarSpline distance_excess(const nurbs::Curve& a, const nurbs::Curve& b, double limit);

struct ParameterRange {
    double begin{};
    double end{};
    bool positive{};
};

// [begin, end] divided where the sign changes, not where the spline only touches zero. Zero counts
// as not positive. Roots are accurate to 1e-12 of the domain.
std::vector<ParameterRange> sign_ranges(const ScalarSpline& spline, double begin, double end);

}  // namespace cusp::adaptive_isocurve
