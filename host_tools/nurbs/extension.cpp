// A control point is the blossom of a span's polynomial at the knots inside its support. The first `degree`
// ones have the end of the domain among these, which moves.
// Source: Ramshaw 1987, polar forms.
#include "host_tools/nurbs/extension.hpp"

#include <algorithm>

#include "host_tools/nurbs/knot_insertion.hpp"

namespace cusp::nurbs {

namespace {

// The blossom of the first span's polynomial: de Boor's algorithm with an argument for each level.
HomogeneousPoint blossom(const ControlRows& rows,
                         std::size_t column,
                         const std::vector<double>& arguments)
{
    const auto p = static_cast<std::size_t>(rows.degree);
    std::vector<HomogeneousPoint> d;
    for (std::size_t j = 0; j <= p; ++j) {
        d.push_back(rows.points[j * rows.width + column]);
    }
    for (std::size_t r = 1; r <= p; ++r) {
        for (std::size_t j = p; j >= r; --j) {
            const double low = rows.knots[j];
            const double high = rows.knots[j + p - r + 1];
            d[j] = blend(d[j - 1], d[j], (arguments[r - 1] - low) / (high - low));
        }
    }
    return d[p];
}

void begin_at(ControlRows& rows, double begin)
{
    const auto p = static_cast<std::size_t>(rows.degree);
    if (!(begin < rows.knots[p])) {
        return;
    }
    ControlRows moved = rows;
    std::fill_n(moved.knots.begin(), p + 1, begin);
    for (std::size_t i = 0; i < p; ++i) {
        const auto first = moved.knots.begin() + static_cast<std::ptrdiff_t>(i) + 1;
        const std::vector<double> arguments(first, first + rows.degree);
        for (std::size_t column = 0; column < rows.width; ++column) {
            moved.points[i * rows.width + column] = blossom(rows, column, arguments);
        }
    }
    rows = std::move(moved);
}

// The other way round.
void reverse(ControlRows& rows)
{
    std::reverse(rows.knots.begin(), rows.knots.end());
    for (double& knot : rows.knots) {
        knot = -knot;
    }
    // rows in reverse order, each reversed; the second reversal restores these
    std::reverse(rows.points.begin(), rows.points.end());
}

void extend(ControlRows& rows, double begin, double end)
{
    begin_at(rows, begin);
    reverse(rows);
    begin_at(rows, -end);
    reverse(rows);
}

}  // namespace

Surface extended(const Surface& surface, double u_begin, double u_end, double v_begin, double v_end)
{
    Surface out = surface;
    ControlRows along_u = control_rows_along_u(out);
    extend(along_u, u_begin, u_end);
    set_rows_along_u(along_u, out);
    ControlRows along_v = control_rows_along_v(out);
    extend(along_v, v_begin, v_end);
    set_rows_along_v(along_v, out);
    return out;
}

}  // namespace cusp::nurbs
