// Boehm's knot insertion on rows of homogeneous control points.
#include "host_tools/geometry/nurbs/knot_insertion.hpp"

#include <algorithm>

#include "host_tools/geometry/nurbs/spline_basis.hpp"

namespace cusp::nurbs {
namespace {

HomogeneousPoint homogeneous(Vec3d p, double w) { return {p.x * w, p.y * w, p.z * w, w}; }

// Source: Boehm 1980; Piegl and Tiller (5.11), one knot at a time.
void insert_once(ControlRows& rows, double u)
{
    const auto p = static_cast<std::size_t>(rows.degree);
    const auto above = std::upper_bound(rows.knots.begin(), rows.knots.end(), u);
    const auto k = static_cast<std::size_t>(above - rows.knots.begin()) - 1;
    const std::size_t s = multiplicity(rows.knots, u);
    std::vector<HomogeneousPoint> points;
    points.reserve(rows.points.size() + rows.width);
    for (std::size_t i = 0; i <= rows.rows(); ++i) {
        const HomogeneousPoint* row = rows.points.data() + i * rows.width;
        if (i + p <= k) {
            points.insert(points.end(), row, row + rows.width);
        } else if (i + s > k) {
            points.insert(points.end(), row - rows.width, row);
        } else {
            const double share = (u - rows.knots[i]) / (rows.knots[i + p] - rows.knots[i]);
            for (std::size_t j = 0; j < rows.width; ++j) {
                points.push_back(blend(*(row + j - rows.width), row[j], share));
            }
        }
    }
    rows.points = std::move(points);
    rows.knots.insert(above, u);
}

}  // namespace

ControlRows control_rows(const Curve& curve)
{
    ControlRows rows{curve.degree, curve.knots, 1, {}};
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
        rows.points.push_back(homogeneous(curve.points[i], curve.weights[i]));
    }
    return rows;
}

ControlRows control_rows_along_u(const Surface& surface)
{
    ControlRows rows{
        surface.degree_u, surface.knots_u, static_cast<std::size_t>(surface.size_v), {}};
    for (std::size_t i = 0; i < surface.points.size(); ++i) {
        rows.points.push_back(homogeneous(surface.points[i], surface.weights[i]));
    }
    return rows;
}

ControlRows control_rows_along_v(const Surface& surface)
{
    const auto size_u = static_cast<std::size_t>(surface.size_u);
    const auto size_v = static_cast<std::size_t>(surface.size_v);
    ControlRows rows{surface.degree_v, surface.knots_v, size_u, {}};
    for (std::size_t j = 0; j < size_v; ++j) {
        for (std::size_t i = 0; i < size_u; ++i) {
            const std::size_t at = i * size_v + j;
            rows.points.push_back(homogeneous(surface.points[at], surface.weights[at]));
        }
    }
    return rows;
}

HomogeneousPoint blend(const HomogeneousPoint& a, const HomogeneousPoint& b, double share)
{
    const double rest = 1 - share;
    return {rest * a.x + share * b.x, rest * a.y + share * b.y, rest * a.z + share * b.z,
            rest * a.w + share * b.w};
}

void set_rows_along_u(const ControlRows& rows, Surface& surface)
{
    const Curve net = to_curve(rows);
    surface.knots_u = rows.knots;
    surface.size_u = static_cast<int>(rows.rows());
    surface.points = net.points;
    surface.weights = net.weights;
}

void set_rows_along_v(const ControlRows& rows, Surface& surface)
{
    surface.knots_v = rows.knots;
    surface.size_v = static_cast<int>(rows.rows());
    surface.points.clear();
    surface.weights.clear();
    for (std::size_t i = 0; i < rows.width; ++i) {
        for (std::size_t j = 0; j < rows.rows(); ++j) {
            const HomogeneousPoint& h = rows.points[j * rows.width + i];
            surface.points.push_back({h.x / h.w, h.y / h.w, h.z / h.w});
            surface.weights.push_back(h.w);
        }
    }
}

Curve to_curve(const ControlRows& rows)
{
    Curve curve{rows.degree, rows.knots, {}, {}};
    for (const HomogeneousPoint& h : rows.points) {
        curve.points.push_back({h.x / h.w, h.y / h.w, h.z / h.w});
        curve.weights.push_back(h.w);
    }
    return curve;
}

std::size_t multiplicity(const std::vector<double>& knots, double u)
{
    const auto [first, last] = std::equal_range(knots.begin(), knots.end(), u);
    return static_cast<std::size_t>(last - first);
}

void insert_to_degree(ControlRows& rows, double u)
{
    const auto p = static_cast<std::size_t>(rows.degree);
    for (std::size_t s = multiplicity(rows.knots, u); s < p; ++s) {
        insert_once(rows, u);
    }
}

std::vector<double> knots_between(const std::vector<double>& knots, double from, double to)
{
    std::vector<double> out{from};
    for (const double knot : knots) {
        if (knot > out.back() && knot < to) {
            out.push_back(knot);
        }
    }
    out.push_back(to);
    return out;
}

std::vector<double> distinct_knots(const std::vector<double>& knots, int degree, std::size_t count)
{
    return knots_between(knots, knots[static_cast<std::size_t>(degree)], knots[count]);
}

std::vector<double> crease_knots(const std::vector<double>& knots, int degree, std::size_t count)
{
    std::vector<double> out;
    for (const double u : distinct_knots(knots, degree, count)) {
        const bool end = out.empty() || u == knots[count];
        if (end || multiplicity(knots, u) >= static_cast<std::size_t>(degree)) {
            out.push_back(u);
        }
    }
    return out;
}

// As insert_to_degree() for each knot in order, in one pass: rows behind a knot are copied once,
// not moved by every insertion before.
void insert_all_to_degree(ControlRows& rows)
{
    const auto p = static_cast<std::size_t>(rows.degree);
    const auto width = static_cast<std::ptrdiff_t>(rows.width);
    const std::vector<double> distinct = distinct_knots(rows.knots, rows.degree, rows.rows());
    const ControlRows from = std::move(rows);
    rows = {from.degree, {}, from.width, {}};
    std::size_t knots_taken = 0;
    auto next_row = from.points.begin();
    const auto knot = [&](std::size_t k) {
        return k < rows.knots.size() ? rows.knots[k]
                                     : from.knots[knots_taken + k - rows.knots.size()];
    };
    for (const double u : distinct) {
        for (; knots_taken < from.knots.size() && from.knots[knots_taken] <= u; ++knots_taken) {
            rows.knots.push_back(from.knots[knots_taken]);
        }
        for (std::size_t s = multiplicity(rows.knots, u); s < p; ++s) {
            const std::size_t last = rows.knots.size() - 1 - s;  // of the rows that change
            for (; rows.points.size() < (last + 1) * rows.width; next_row += width) {
                rows.points.insert(rows.points.end(), next_row, next_row + width);
            }
            const auto after = static_cast<std::ptrdiff_t>(last + 1) * width;
            const std::vector<HomogeneousPoint> copy{rows.points.begin() + after - width,
                                                     rows.points.begin() + after};
            rows.points.insert(rows.points.begin() + after, copy.begin(), copy.end());
            for (std::size_t i = last; i + p >= rows.knots.size(); --i) {
                const double share = (u - knot(i)) / (knot(i + p) - knot(i));
                HomogeneousPoint* row = rows.points.data() + i * rows.width;
                for (std::size_t j = 0; j < rows.width; ++j) {
                    row[j] = blend(*(row + j - rows.width), row[j], share);
                }
            }
            rows.knots.push_back(u);
        }
    }
    rows.knots.insert(rows.knots.end(),
                      from.knots.begin() + static_cast<std::ptrdiff_t>(knots_taken),
                      from.knots.end());
    rows.points.insert(rows.points.end(), next_row, from.points.end());
}

void clamp_ends(ControlRows& rows)
{
    const auto p = static_cast<std::ptrdiff_t>(rows.degree);
    const double begin = rows.knots[static_cast<std::size_t>(p)];
    const double end = rows.knots[rows.rows()];
    insert_to_degree(rows, begin);
    insert_to_degree(rows, end);
    const auto width = static_cast<std::ptrdiff_t>(rows.width);
    // The spans between the last knot at the begin and the first one at the end remain.
    const auto last = std::upper_bound(rows.knots.begin(), rows.knots.end(), begin) - 1;
    const auto first = std::lower_bound(rows.knots.begin(), rows.knots.end(), end);
    const auto first_row = (last - rows.knots.begin()) - p;
    const auto end_row = first - rows.knots.begin();
    std::vector<double> knots(static_cast<std::size_t>(p), begin);
    knots.insert(knots.end(), last, first + 1);
    knots.insert(knots.end(), static_cast<std::size_t>(p), end);
    rows.points = {rows.points.begin() + first_row * width, rows.points.begin() + end_row * width};
    rows.knots = std::move(knots);
}

namespace {

bool ends_are_clamped(const std::vector<double>& knots, int degree)
{
    const auto p = static_cast<std::size_t>(degree);
    return knots[0] == knots[p] && knots.back() == knots[knots.size() - 1 - p];
}

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

// A control point is the blossom of a span's polynomial at the knots inside its support. The first `degree`
// ones have the end of the domain among these, which moves here. Source: Ramshaw 1987, polar forms.
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

Curve clamped(const Curve& curve)
{
    if (ends_are_clamped(curve.knots, curve.degree)) {
        return curve;
    }
    ControlRows rows = control_rows(curve);
    clamp_ends(rows);
    return to_curve(rows);
}

Surface clamped(const Surface& surface)
{
    Surface out = surface;
    if (!ends_are_clamped(out.knots_u, out.degree_u)) {
        ControlRows rows = control_rows_along_u(out);
        clamp_ends(rows);
        set_rows_along_u(rows, out);
    }
    if (!ends_are_clamped(out.knots_v, out.degree_v)) {
        ControlRows rows = control_rows_along_v(out);
        clamp_ends(rows);
        set_rows_along_v(rows, out);
    }
    return out;
}

Surface with_knots(const Surface& surface,
                   const std::vector<double>& more_u,
                   const std::vector<double>& more_v)
{
    Surface out = surface;
    ControlRows rows = control_rows_along_u(out);
    for (const double u : more_u) {
        insert_once(rows, u);
    }
    set_rows_along_u(rows, out);
    rows = control_rows_along_v(out);
    for (const double v : more_v) {
        insert_once(rows, v);
    }
    set_rows_along_v(rows, out);
    return out;
}

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
