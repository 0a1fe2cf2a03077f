// Intersections of lines and arcs without trigonometry: those of lines and circles, of which the
// points on the edges are kept by their side of the chord.
#include "host_tools/geometry/offset/edge_crossings.hpp"

#include <algorithm>

namespace cusp::offset {

namespace {

bool near(Vec2d a, Vec2d b, double overrun)
{
    return std::abs(a.x - b.x) <= overrun && std::abs(a.y - b.y) <= overrun;
}

// True if a point of the edge's line or circle belongs to the edge itself.
bool within(const Edge& edge, Vec2d p, double overrun)
{
    if (near(p, edge.start, overrun) || near(p, edge.end, overrun)) {
        return true;
    }
    const Vec2d chord = edge.end - edge.start;
    if (edge.turn != 0) {
        return cross(chord, p - edge.start) * edge.turn < 0.0;
    }
    const double along = dot(p - edge.start, chord);
    return along > 0.0 && along < dot(chord, chord);
}

void keep(Crossings& found, const Edge& a, const Edge& b, Vec2d p, double overrun)
{
    if (within(a, p, overrun) && within(b, p, overrun)) {
        found.try_push_back(p);
    }
}

// For edges on one line or circle: the ends of each that lie on the other.
Crossings common_ends(const Edge& a, const Edge& b, double overrun)
{
    Crossings found;
    for (const Vec2d p : {a.start, a.end}) {
        if (within(b, p, overrun)) {
            found.try_push_back(p);
        }
    }
    for (const Vec2d p : {b.start, b.end}) {
        if (within(a, p, overrun)) {
            found.try_push_back(p);
        }
    }
    return found;
}

Crossings of_lines(const Edge& a, const Edge& b, double overrun)
{
    const Vec2d u = a.end - a.start;
    const Vec2d v = b.end - b.start;
    const Vec2d w = b.start - a.start;
    const double bend = cross(u, v);
    const double size = std::sqrt(dot(u, u) * dot(v, v));
    if (std::abs(bend) <= 1e-12 * size) {
        const double apart = std::abs(cross(u, w)) / std::sqrt(std::max(dot(u, u), 1e-300));
        return apart <= overrun ? common_ends(a, b, overrun) : Crossings{};
    }
    Crossings found;
    keep(found, a, b, a.start + u * (cross(w, v) / bend), overrun);
    return found;
}

Crossings of_line_and_arc(const Edge& line, const Edge& arc, double overrun)
{
    const Vec2d along = unit(line.end - line.start);
    const Vec2d foot = line.start + along * dot(arc.centre - line.start, along);
    const double away = distance(foot, arc.centre);
    Crossings found;
    if (away > arc.radius + overrun) {
        return found;
    }
    const double square = arc.radius * arc.radius - away * away;
    const double half = std::sqrt(std::max(square, 0.0));
    keep(found, line, arc, foot - along * half, overrun);
    if (half > overrun) {
        keep(found, line, arc, foot + along * half, overrun);
    }
    return found;
}

Crossings of_arcs(const Edge& a, const Edge& b, double overrun)
{
    const Vec2d apart = b.centre - a.centre;
    const double gap = std::sqrt(dot(apart, apart));
    if (gap <= overrun && std::abs(a.radius - b.radius) <= overrun) {
        return common_ends(a, b, overrun);
    }
    Crossings found;
    if (gap <= 1e-300 || gap > a.radius + b.radius + overrun ||
        gap < std::abs(a.radius - b.radius) - overrun) {
        return found;
    }
    // Distance from a's centre to the common chord, in a form without cancellation for equal radii.
    const double along = 0.5 * (gap + (a.radius - b.radius) * (a.radius + b.radius) / gap);
    const double square = (a.radius - along) * (a.radius + along);
    const double half = std::sqrt(std::max(square, 0.0));
    const Vec2d axis = apart * (1.0 / gap);
    const Vec2d foot = a.centre + axis * along;
    keep(found, a, b, foot - left_normal(axis) * half, overrun);
    if (half > overrun) {
        keep(found, a, b, foot + left_normal(axis) * half, overrun);
    }
    return found;
}

}  // namespace

Crossings crossings(const Edge& a, const Edge& b, double overrun)
{
    if (a.turn == 0 && b.turn == 0) {
        return of_lines(a, b, overrun);
    }
    if (a.turn == 0) {
        return of_line_and_arc(a, b, overrun);
    }
    if (b.turn == 0) {
        return of_line_and_arc(b, a, overrun);
    }
    return of_arcs(a, b, overrun);
}

}  // namespace cusp::offset
