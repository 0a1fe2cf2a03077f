// Intersections of lines and arcs without trigonometry: those of lines and circles, of which the
// points on the edges are kept by their side of the chord.
#include "host_tools/offset/edge_crossings.hpp"

#include <algorithm>

namespace cusp::offset {

namespace {

bool near(Vec2d a, Vec2d b, double slack)
{
    return std::abs(a.x - b.x) <= slack && std::abs(a.y - b.y) <= slack;
}

// Whether a point of the edge's line or circle belongs to the edge itself.
bool within(const Edge& edge, Vec2d p, double slack)
{
    if (near(p, edge.start, slack) || near(p, edge.end, slack)) {
        return true;
    }
    const Vec2d chord = edge.end - edge.start;
    if (edge.turn != 0) {
        return cross(chord, p - edge.start) * edge.turn < 0.0;
    }
    const double along = dot(p - edge.start, chord);
    return along > 0.0 && along < dot(chord, chord);
}

void keep(Crossings& found, const Edge& a, const Edge& b, Vec2d p, double slack)
{
    if (within(a, p, slack) && within(b, p, slack)) {
        found.try_push_back(p);
    }
}

// For edges on one line or circle: the ends of each that lie on the other.
Crossings common_ends(const Edge& a, const Edge& b, double slack)
{
    Crossings found;
    for (const Vec2d p : {a.start, a.end}) {
        if (within(b, p, slack)) {
            found.try_push_back(p);
        }
    }
    for (const Vec2d p : {b.start, b.end}) {
        if (within(a, p, slack)) {
            found.try_push_back(p);
        }
    }
    return found;
}

Crossings of_lines(const Edge& a, const Edge& b, double slack)
{
    const Vec2d u = a.end - a.start;
    const Vec2d v = b.end - b.start;
    const Vec2d w = b.start - a.start;
    const double bend = cross(u, v);
    const double size = std::sqrt(dot(u, u) * dot(v, v));
    if (std::abs(bend) <= 1e-12 * size) {
        const double apart = std::abs(cross(u, w)) / std::sqrt(std::max(dot(u, u), 1e-300));
        return apart <= slack ? common_ends(a, b, slack) : Crossings{};
    }
    Crossings found;
    keep(found, a, b, a.start + u * (cross(w, v) / bend), slack);
    return found;
}

Crossings of_line_and_arc(const Edge& line, const Edge& arc, double slack)
{
    const Vec2d along = unit(line.end - line.start);
    const Vec2d foot = line.start + along * dot(arc.centre - line.start, along);
    const double away = distance(foot, arc.centre);
    Crossings found;
    if (away > arc.radius + slack) {
        return found;
    }
    const double square = arc.radius * arc.radius - away * away;
    const double half = std::sqrt(std::max(square, 0.0));
    keep(found, line, arc, foot - along * half, slack);
    if (half > slack) {
        keep(found, line, arc, foot + along * half, slack);
    }
    return found;
}

Crossings of_arcs(const Edge& a, const Edge& b, double slack)
{
    const Vec2d apart = b.centre - a.centre;
    const double gap = std::sqrt(dot(apart, apart));
    if (gap <= slack && std::abs(a.radius - b.radius) <= slack) {
        return common_ends(a, b, slack);
    }
    Crossings found;
    if (gap <= 1e-300 || gap > a.radius + b.radius + slack ||
        gap < std::abs(a.radius - b.radius) - slack) {
        return found;
    }
    // Distance from a's centre to the common chord, in a form without cancellation for equal radii.
    const double along = 0.5 * (gap + (a.radius - b.radius) * (a.radius + b.radius) / gap);
    const double square = (a.radius - along) * (a.radius + along);
    const double half = std::sqrt(std::max(square, 0.0));
    const Vec2d axis = apart * (1.0 / gap);
    const Vec2d foot = a.centre + axis * along;
    keep(found, a, b, foot - left_normal(axis) * half, slack);
    if (half > slack) {
        keep(found, a, b, foot + left_normal(axis) * half, slack);
    }
    return found;
}

}  // namespace

Crossings crossings(const Edge& a, const Edge& b, double slack)
{
    if (a.turn == 0 && b.turn == 0) {
        return of_lines(a, b, slack);
    }
    if (a.turn == 0) {
        return of_line_and_arc(a, b, slack);
    }
    if (b.turn == 0) {
        return of_line_and_arc(b, a, slack);
    }
    return of_arcs(a, b, slack);
}

}  // namespace cusp::offset
