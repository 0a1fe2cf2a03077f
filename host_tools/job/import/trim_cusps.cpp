#include "host_tools/job/import/trim_cusps.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::import {

using nurbs::ControlRows;
using nurbs::Curve;
using nurbs::Surface;

namespace {

constexpr int kPlaces = 256;  // along half a curve
constexpr double kApart =
    5e-5;                       // of the domain's longer side; trims less than 1e-5 apart may cross
constexpr double kSlender = 4;  // a tip is longer than its width by this

// The part of a clamped curve between two parameters of its domain.
Curve part_of(const Curve& curve, double from, double to)
{
    ControlRows rows = control_rows(curve);
    nurbs::insert_to_degree(rows, from);
    nurbs::insert_to_degree(rows, to);
    const auto degree = static_cast<std::size_t>(rows.degree);
    const auto after = std::upper_bound(rows.knots.begin(), rows.knots.end(), from);
    const auto end = std::lower_bound(rows.knots.begin(), rows.knots.end(), to);
    ControlRows part{rows.degree, std::vector<double>(degree + 1, from), 1, {}};
    part.knots.insert(part.knots.end(), after, end);
    part.knots.insert(part.knots.end(), degree + 1, to);
    // the control point on the curve where a knot of full multiplicity is
    const auto first = (after - rows.knots.begin()) - 1 - rows.degree;
    const auto last = (end - rows.knots.begin()) - 1;
    part.points.assign(rows.points.begin() + first, rows.points.begin() + last + 1);
    return to_curve(part);
}

struct Place {
    double parameter;
    Vec3d uv;
};

// Places along half a curve from one of its ends, the nearer to it the denser.
std::vector<Place> places_from(const Curve& curve, bool from_end)
{
    std::vector<Place> places;
    for (int k = 0; k <= kPlaces; ++k) {
        const double t = 0.5 * k * k / (kPlaces * kPlaces);
        const double share = from_end ? 1 - t : t;
        const double parameter = curve.domain_begin() * (1 - share) + curve.domain_end() * share;
        places.push_back({parameter, point_at(curve, parameter)});
    }
    return places;
}

double side_of(Vec3d a, Vec3d b, Vec3d p)
{
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

bool chords_cross(Vec3d a, Vec3d b, Vec3d c, Vec3d d)
{
    return side_of(a, b, c) * side_of(a, b, d) < 0 && side_of(c, d, a) * side_of(c, d, b) < 0;
}

// The first place after the last crossing of both curves; 1 where they do not cross.
std::size_t after_crossings(const std::vector<Place>& first, const std::vector<Place>& next)
{
    std::size_t last = 1;
    for (std::size_t i = 0; i + 1 < first.size(); ++i) {
        for (std::size_t j = 0; j + 1 < next.size(); ++j) {
            if (chords_cross(first[i].uv, first[i + 1].uv, next[j].uv, next[j + 1].uv)) {
                last = i + 1;
            }
        }
    }
    return last;
}

struct Cusp {
    double end;     // parameter of the first curve
    double begin;   // of the next one
    double widest;  // mm
};

// The place where the tip between two curves is as wide as `width`, after their last crossing; none
// if they meet at a wider angle, or are apart by more than `gap` before.
std::optional<Cusp> cusp_between(
    const Curve& first, const Curve& next, double width, double gap, const Surface& surface)
{
    double widest = 0;
    const std::vector<Place> ends = places_from(first, true);
    const std::vector<Place> begins = places_from(next, false);
    const std::size_t crossed = after_crossings(ends, begins);
    for (std::size_t k = 1; k < ends.size(); ++k) {
        const Vec3d at = ends[k].uv;
        const auto nearest = std::min_element(
            begins.begin(), begins.end(),
            [&](const Place& a, const Place& b) { return norm(a.uv - at) < norm(b.uv - at); });
        const Vec3d beside = nearest->uv;
        widest = std::max(
            widest, norm(point_at(surface, at.x, at.y) - point_at(surface, beside.x, beside.y)));
        if (widest > gap) {
            return std::nullopt;
        }
        if (k >= crossed && norm(beside - at) >= width) {
            const bool slender = norm(at - ends[0].uv) > kSlender * width &&
                                 nearest != begins.begin() && nearest + 1 != begins.end();
            return slender ? std::optional{Cusp{ends[k].parameter, nearest->parameter, widest}}
                           : std::nullopt;
        }
    }
    return std::nullopt;
}

}  // namespace

double cut_cusps(std::vector<Curve>& loop, double gap, const Surface& surface)
{
    const double width =
        kApart * std::max(surface.u_end() - surface.u_begin(), surface.v_end() - surface.v_begin());
    double widest = 0;
    for (std::size_t i = 0; i < loop.size() && loop.size() > 1; ++i) {
        const std::size_t following = (i + 1) % loop.size();
        const auto cusp = cusp_between(loop[i], loop[following], width, gap, surface);
        if (!cusp) {
            continue;
        }
        const Curve first = part_of(loop[i], loop[i].domain_begin(), cusp->end);
        const Curve next = part_of(loop[following], cusp->begin, loop[following].domain_end());
        const Vec3d from = first.points.back();
        const Vec3d to = next.points.front();
        loop[i] = first;
        loop[following] = next;
        loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                    Curve{1, {0, 0, 1, 1}, {from, to}, {1, 1}});
        ++i;
        widest = std::max(widest, cusp->widest);
    }
    return widest;
}

}  // namespace cusp::import
