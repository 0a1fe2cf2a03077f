// Groups trimming curves into loops and checks how they nest.
#include "host_tools/job/import/trim_loops.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/job/loop_shape.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::chained;
using job::crossing_of;
using job::encloses;
using job::Loop;
using job::loop_polyline;
using job::signed_area;
using nurbs::Curve;
using nurbs::Surface;

namespace {

// Gaps and excursions up to this fraction of the domain's longer side are rounding of the file.
constexpr double kParameterShare = 1e-5;

struct Domain {
    double u_begin, u_end, v_begin, v_end;
    double size() const { return std::max(u_end - u_begin, v_end - v_begin); }
};

bool meet(Vec3d a, Vec3d b, double allowed)
{
    return elementary::hypot(a.x - b.x, a.y - b.y) <= allowed;
}

Curve parameter_line(Vec2d a, Vec2d b)
{
    return {1, {0, 0, 1, 1}, {{a.x, a.y, 0}, {b.x, b.y, 0}}, {1, 1}};
}

// Refuses a loop whose mean width is below rounding.
void check_area(const std::vector<Vec2d>& closed,
                std::size_t number,
                double allowed,
                const std::string& place)
{
    double length = 0;
    for (std::size_t i = 1; i < closed.size(); ++i) {
        length += norm(closed[i] - closed[i - 1]);
    }
    const double area = signed_area(closed);
    if (!(std::abs(area) > allowed * length)) {
        throw InputError(
            fmt::format("{}: trim loop {} encloses {:.3g} of the domain's (u, v), that is no area",
                        place, number, area));
    }
}

Loop edge_of(const Domain& d)
{
    const Vec2d a{d.u_begin, d.v_begin};
    const Vec2d b{d.u_end, d.v_begin};
    const Vec2d c{d.u_end, d.v_end};
    const Vec2d e{d.u_begin, d.v_end};
    return {parameter_line(a, b), parameter_line(b, c), parameter_line(c, e), parameter_line(e, a)};
}

void check_inside(const Loop& loop, const Domain& d, double allowed, const std::string& place)
{
    for (const Vec2d p : loop_polyline(loop, allowed)) {
        if (p.x < d.u_begin - allowed || p.x > d.u_end + allowed || p.y < d.v_begin - allowed ||
            p.y > d.v_end + allowed) {
            throw InputError(
                fmt::format("{}: a trim leaves the domain at u {:.6g} v {:.6g}; it "
                            "reaches from {:g} {:g} to {:g} {:g}",
                            place, p.x, p.y, d.u_begin, d.v_begin, d.u_end, d.v_end));
        }
    }
}

// Groups curves into loops by their ends.
std::vector<Loop> grouped(const std::vector<Curve>& curves,
                          double allowed,
                          const std::string& place)
{
    std::vector<Loop> loops;
    Loop open;
    for (const Curve& curve : curves) {
        open.push_back(curve);
        if (meet(open.front().points.front(), curve.points.back(), allowed)) {
            loops.push_back(chained(std::move(open), allowed, place));
            open.clear();
        }
    }
    if (!open.empty()) {
        chained(open, allowed, place);  // throws with the gap
        throw InputError(place + ": the last trim is not closed");
    }
    return loops;
}

// Compares point by point, in both directions.
bool same_loop(const std::vector<Vec2d>& a, const std::vector<Vec2d>& b)
{
    const auto same = [](Vec2d p, Vec2d q) {
        return p.x == q.x && p.y == q.y;
    };
    return a.size() == b.size() && (std::equal(a.begin(), a.end(), b.begin(), same) ||
                                    std::equal(a.begin(), a.end(), b.rbegin(), same));
}

void check_nesting(const std::vector<std::vector<Vec2d>>& polylines,
                   double allowed,
                   const std::string& place)
{
    if (const auto at = crossing_of(polylines)) {
        throw InputError(
            fmt::format("{}: trims cross themselves or each other near u {:.6g} v "
                        "{:.6g}",
                        place, at->x, at->y));
    }
    for (std::size_t i = 0; i < polylines.size(); ++i) {
        check_area(polylines[i], i + 1, allowed, place);
        const Vec2d inside = 0.5 * (polylines[i][0] + polylines[i][1]);
        std::size_t depth = 0;
        for (std::size_t j = 0; j < polylines.size(); ++j) {
            if (j != i && same_loop(polylines[i], polylines[j])) {
                throw InputError(
                    fmt::format("{}: trim loops {} and {} are the same", place, i + 1, j + 1));
            }
            depth += j != i && encloses(polylines[j], inside) ? 1U : 0U;
        }
        const bool outer = signed_area(polylines[i]) > 0;
        if (outer != (depth % 2 == 0)) {
            throw InputError(fmt::format(
                "{}: trims contradict each other: loop {} runs {} and lies inside {} others; "
                "{}",
                place, i + 1, outer ? "counter-clockwise" : "clockwise", depth,
                outer        ? "what it encloses is there already: a hole runs clockwise"
                : depth == 0 ? "a hole outside every outer loop: an outer loop runs "
                               "counter-clockwise"
                             : "a hole inside a hole"));
        }
    }
}

}  // namespace

std::vector<std::vector<Curve>> trim_loops(const std::vector<Curve>& curves,
                                           const Surface& surface,
                                           const std::string& place)
{
    const Domain domain{surface.u_begin(), surface.u_end(), surface.v_begin(), surface.v_end()};
    const double allowed = kParameterShare * domain.size();
    std::vector<Loop> loops = grouped(curves, allowed, place);
    if (loops.empty()) {
        return {};
    }
    bool has_outer = false;
    for (const Loop& loop : loops) {
        check_inside(loop, domain, allowed, place);
        has_outer = has_outer || signed_area(loop_polyline(loop, allowed)) > 0;
    }
    if (!has_outer) {
        loops.insert(loops.begin(), edge_of(domain));
    }
    std::vector<std::vector<Vec2d>> polylines;
    for (const Loop& loop : loops) {
        polylines.push_back(loop_polyline(loop, allowed));
    }
    check_nesting(polylines, allowed, place);
    std::stable_partition(loops.begin(), loops.end(), [&](const Loop& loop) {
        return signed_area(loop_polyline(loop, allowed)) > 0;
    });
    return loops;
}

}  // namespace cusp::import
