// Cox-de Boor's recurrence, row by row.
#include "host_tools/geometry/nurbs/spline_basis.hpp"

#include <algorithm>

namespace cusp::nurbs {
namespace {

using Row = SplineBasis::Row;

// Raises the functions of degree k - 1 in `row` to degree k. The denominators all span the interval
// of u and so are positive.
void raise_degree(const double* knot, std::size_t k, double u, Row& row)
{
    double saved = 0;
    for (std::size_t j = 0; j < k; ++j) {
        const double right = knot[j + 1];
        const double left = *(knot + j + 1 - k);
        const double share = row[j] / (right - left);
        row[j] = saved + (right - u) * share;
        saved = (u - left) * share;
    }
    row[k] = saved;
}

// Derivatives of degree-k functions from values (or derivatives) of degree k - 1.
void derive(const double* knot, std::size_t k, const Row& lower, Row& out)
{
    double saved = 0;
    for (std::size_t j = 0; j < k; ++j) {
        const double slope =
            static_cast<double>(k) * lower[j] / (knot[j + 1] - *(knot + j + 1 - k));
        out[j] = saved - slope;
        saved = slope;
    }
    out[k] = saved;
}

}  // namespace

std::size_t span_at(const std::vector<double>& knots, int degree, std::size_t count, double u)
{
    const auto begin = knots.begin() + degree;
    const auto end = knots.begin() + static_cast<std::ptrdiff_t>(count);
    if (u >= *end) {
        return static_cast<std::size_t>(std::lower_bound(begin, end, *end) - knots.begin()) - 1;
    }
    const auto above = std::upper_bound(begin + 1, end, u);
    return static_cast<std::size_t>(above - knots.begin()) - 1;
}

void evaluate_basis(const std::vector<double>& knots,
                    int degree,
                    std::size_t count,
                    double u,
                    bool derivatives,
                    SplineBasis& basis)
{
    const auto p = static_cast<std::size_t>(degree);
    u = std::clamp(u, knots[p], knots[count]);
    const std::size_t span = span_at(knots, degree, count, u);
    const double* knot = knots.data() + span;
    basis.first = span - p;
    Row& value = basis.value;
    value[0] = 1;
    Row second_lower;
    Row first_lower;
    for (std::size_t k = 1; k <= p; ++k) {
        if (derivatives && k + 1 == p) {
            second_lower = value;
        }
        if (derivatives && k == p) {
            first_lower = value;
        }
        raise_degree(knot, k, u, value);
    }
    if (!derivatives) {
        return;
    }
    derive(knot, p, first_lower, basis.first_derivative);
    if (p == 1) {
        basis.second_derivative[0] = basis.second_derivative[1] = 0;
        return;
    }
    Row slope;
    derive(knot, p - 1, second_lower, slope);
    derive(knot, p, slope, basis.second_derivative);
}

}  // namespace cusp::nurbs
