// Closed contours of lines and true arcs in the plane, and the regions they bound. Millimetres.
#pragma once

#include <cmath>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::offset {

// A line or an arc. turn: 0 straight, +1 counter-clockwise (centre on the left), -1 clockwise.
// An arc sweeps less than half a turn, so its points are ordered along its chord.
struct Edge {
    Vec2d start;
    Vec2d end;
    Vec2d centre;
    double radius{};
    int turn{};
};

// A closed chain: each edge starts at the end of the one before, the first at the end of the last.
using Contour = std::vector<Edge>;

// mm: points of a region no farther apart than this are the same.
inline constexpr double kSamePoint = 1e-7;

// The points to the left of all contours: outer contours run counter-clockwise, holes clockwise.
struct Region2d {
    std::vector<Contour> contours;
};

inline Edge line_edge(Vec2d start, Vec2d end) { return {start, end, {}, 0.0, 0}; }

// The arc from start to end about centre. Precondition: both lie on the circle, sweep below half a
// turn.
Edge arc_edge(Vec2d start, Vec2d end, Vec2d centre, int turn);

inline Vec2d left_normal(Vec2d t) { return {-t.y, t.x}; }
inline double distance(Vec2d a, Vec2d b) { return std::sqrt(dot(a - b, a - b)); }
inline Vec2d unit(Vec2d a)
{
    const double size = std::sqrt(dot(a, a));
    return size > 0.0 ? a * (1.0 / size) : Vec2d{0.0, 0.0};
}

double length(const Edge& edge);
double sweep(const Edge& edge);  // radians, >= 0; 0 for a line
inline Vec2d tangent_at_start(const Edge& edge)
{
    return edge.turn == 0 ? unit(edge.end - edge.start)
                          : left_normal(edge.start - edge.centre) * (edge.turn / edge.radius);
}
inline Vec2d tangent_at_end(const Edge& edge)
{
    return edge.turn == 0 ? unit(edge.end - edge.start)
                          : left_normal(edge.end - edge.centre) * (edge.turn / edge.radius);
}

// The point at a share of the edge's length, and the unit tangent there. share in [0, 1].
Vec2d point_on(const Edge& edge, double share);
Vec2d tangent_on(const Edge& edge, double share);

double distance_to(const Edge& edge, Vec2d point);
Vec2d nearest_on(const Edge& edge, Vec2d point);
Edge reversed(const Edge& edge);

// The part of the edge between two points on it.
Edge between(const Edge& edge, Vec2d from, Vec2d to);
// Equal parts of the edge, each no longer than `most` (mm).
std::vector<Edge> pieces_of(const Edge& edge, double most);

double length(const Contour& contour);
double area(const Contour& contour);  // mm^2, > 0 where it runs counter-clockwise
double area(const Region2d& region);  // mm^2, holes taken off
Contour reversed(const Contour& contour);

// True if a ray from the point to the right crosses the edge an odd number of times. The parity
// over all edges of a contour shows whether the contour runs around the point.
bool crossed_by_ray(const Edge& edge, Vec2d point);

// True if the contour runs around the point, in either direction.
bool surrounds(const Contour& contour, Vec2d point);

// True if the point belongs to the region; undefined on a contour.
bool contains(const Region2d& region, Vec2d point);

// The least distance from the point to the contours' edges, by brute force.
double distance_to(const Region2d& region, Vec2d point);

struct Box2d {
    double x0{kUnbounded};
    double y0{kUnbounded};
    double x1{-kUnbounded};
    double y1{-kUnbounded};
};
Box2d box_of(const Edge& edge);
Box2d box_of(const Region2d& region);

// The edges of all contours, contour by contour.
std::vector<Edge> edges_of(const Region2d& region);

// An outer contour with the holes directly inside it; indices into Region2d::contours.
struct RegionPart {
    std::size_t outer;
    std::vector<std::size_t> holes;
};

// The connected parts of a region.
std::vector<RegionPart> connected_parts(const Region2d& region);

}  // namespace cusp::offset
