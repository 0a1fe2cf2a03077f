// Contours by their corners; arcs in quarters.
#include "host_tools/job/import/gerber_shapes.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::import {

using offset::Contour;
using offset::Edge;
using offset::Region2d;

namespace {

constexpr double kQuarterTurn = kPi / 2;
constexpr double kChord = 2e-4;  // mm

Vec2d on_circle(Vec2d centre, double radius, double angle)
{
    return {centre.x + radius * elementary::cos(angle), centre.y + radius * elementary::sin(angle)};
}

// From a to b by half a turn about their middle, counter-clockwise.
void append_half_turn(Contour& contour, Vec2d a, Vec2d b)
{
    const Vec2d centre = 0.5 * (a + b);
    const Vec2d out = a - centre;
    const Vec2d top = centre + offset::left_normal(out);
    contour.push_back(offset::arc_edge(a, top, centre, 1));
    contour.push_back(offset::arc_edge(top, b, centre, 1));
}

double turn_of(Vec2d a, Vec2d b, Vec2d c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The corners of the convex hull, counter-clockwise.
std::vector<Vec2d> hull_of(std::vector<Vec2d> points)
{
    std::sort(points.begin(), points.end(),
              [](Vec2d a, Vec2d b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    std::vector<Vec2d> hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t begin = hull.size();
        for (const Vec2d p : points) {
            while (hull.size() >= begin + 2 &&
                   turn_of(hull[hull.size() - 2], hull.back(), p) <= 0) {
                hull.pop_back();
            }
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

Region2d chord_capsules(const CircularWay& way, double radius)
{
    const double step =
        2 * elementary::acos(std::max(0.0, 1 - kChord / std::max(way.radius, kChord)));
    const int count = std::max(1, static_cast<int>(std::ceil(std::fabs(way.sweep) / step)));
    Region2d region;
    for (int k = 0; k < count; ++k) {
        const double from = way.start + way.sweep * k / count;
        const double to = way.start + way.sweep * (k + 1) / count;
        region.contours.push_back(capsule_contour(on_circle(way.centre, way.radius, from),
                                                  on_circle(way.centre, way.radius, to), radius));
    }
    return region;
}

}  // namespace

std::vector<Edge> arc_edges(const CircularWay& way)
{
    const int count =
        std::max(1, static_cast<int>(std::ceil(std::fabs(way.sweep) / kQuarterTurn - 1e-9)));
    const int turn = way.sweep < 0 ? -1 : 1;
    const bool closed = std::fabs(way.sweep) > 2 * kPi - 1e-9;
    const Vec2d first = on_circle(way.centre, way.radius, way.start);
    std::vector<Edge> edges;
    Vec2d from = first;
    for (int k = 1; k <= count; ++k) {
        const Vec2d to = closed && k == count
                             ? first
                             : on_circle(way.centre, way.radius, way.start + way.sweep * k / count);
        edges.push_back(offset::arc_edge(from, to, way.centre, turn));
        from = to;
    }
    return edges;
}

Contour circle_contour(Vec2d centre, double radius)
{
    return arc_edges({centre, radius, 0, 2 * kPi});
}

Contour polygon_contour(std::vector<Vec2d> points)
{
    Contour contour;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Vec2d next = points[(k + 1) % points.size()];
        if (norm(next - points[k]) > 0) {
            contour.push_back(offset::line_edge(points[k], next));
        }
    }
    return offset::area(contour) < 0 ? offset::reversed(contour) : contour;
}

Contour rectangle_contour(Vec2d centre, double width, double height)
{
    const Vec2d half{width / 2, height / 2};
    return polygon_contour({centre - half,
                            {centre.x + half.x, centre.y - half.y},
                            centre + half,
                            {centre.x - half.x, centre.y + half.y}});
}

Contour obround_contour(Vec2d centre, double width, double height)
{
    const double radius = std::min(width, height) / 2;
    const Vec2d half =
        width > height ? Vec2d{width / 2 - radius, 0} : Vec2d{0, height / 2 - radius};
    return capsule_contour(centre - half, centre + half, radius);
}

Contour capsule_contour(Vec2d from, Vec2d to, double radius)
{
    if (norm(to - from) < offset::kSamePoint) {
        return circle_contour(from, radius);
    }
    const Vec2d beside = offset::left_normal(offset::unit(to - from)) * radius;
    Contour contour{offset::line_edge(from - beside, to - beside)};
    append_half_turn(contour, to - beside, to + beside);
    contour.push_back(offset::line_edge(to + beside, from + beside));
    append_half_turn(contour, from + beside, from - beside);
    return contour;
}

Contour swept_contour(const std::vector<Vec2d>& polygon, Vec2d from, Vec2d to)
{
    std::vector<Vec2d> points;
    for (const Vec2d corner : polygon) {
        points.push_back(from + corner);
        points.push_back(to + corner);
    }
    return polygon_contour(hull_of(std::move(points)));
}

Region2d thick_arc(const CircularWay& way, double radius)
{
    if (way.radius <= radius + kChord) {
        return chord_capsules(way, radius);
    }
    if (std::fabs(way.sweep) > 2 * kPi - 1e-9) {
        return {{circle_contour(way.centre, way.radius + radius),
                 offset::reversed(circle_contour(way.centre, way.radius - radius))}};
    }
    CircularWay outer{way.centre, way.radius + radius, way.start, way.sweep};
    if (way.sweep < 0) {
        outer.start = way.start + way.sweep;
        outer.sweep = -way.sweep;
    }
    CircularWay inner = outer;
    inner.radius = way.radius - radius;
    Contour contour = arc_edges(outer);
    const Contour back = offset::reversed(arc_edges(inner));
    append_half_turn(contour, contour.back().end, back.front().start);
    contour.insert(contour.end(), back.begin(), back.end());
    append_half_turn(contour, back.back().end, contour.front().start);
    return {{contour}};
}

Region2d mapped(const PlaneMap& map, const Region2d& region)
{
    const bool mirrored = map.determinant() < 0;
    const double scale = norm(map.x);
    Region2d out;
    for (const Contour& contour : region.contours) {
        Contour moved;
        for (const Edge& edge : contour) {
            moved.push_back({map.of(edge.start), map.of(edge.end), map.of(edge.centre),
                             edge.radius * scale, mirrored ? -edge.turn : edge.turn});
        }
        out.contours.push_back(mirrored ? offset::reversed(moved) : std::move(moved));
    }
    return out;
}

}  // namespace cusp::import
