// Measures of lines, arcs, contours and regions.
#include "host_tools/geometry/offset/contour.hpp"

#include <algorithm>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::offset {

namespace {

double cross_from(Vec2d origin, Vec2d a, Vec2d b) { return cross(a - origin, b - origin); }

// True if the point lies in the wedge that the arc spans around its centre.
bool in_wedge(const Edge& arc, Vec2d point)
{
    return cross_from(arc.centre, arc.start, point) * arc.turn >= 0.0 &&
           cross_from(arc.centre, point, arc.end) * arc.turn >= 0.0;
}

// The side of the chord on which the point lies, > 0 on the left. A point on the chord's line
// counts as moved up by an infinitesimal step; one beside a chord that its ray meets as moved
// right. The chord's polygon and the arc's segment need the same choice for consistent parities.
double side_of_chord(const Edge& edge, bool straddles, Vec2d p)
{
    const double side = cross_from(edge.start, edge.end, p);
    if (side != 0.0) {
        return side;
    }
    return straddles ? edge.start.y - edge.end.y : edge.end.x - edge.start.x;
}

}  // namespace

Edge arc_edge(Vec2d start, Vec2d end, Vec2d centre, int turn)
{
    return {start, end, centre, 0.5 * (distance(start, centre) + distance(end, centre)), turn};
}

double sweep(const Edge& edge)
{
    if (edge.turn == 0) {
        return 0.0;
    }
    const Vec2d a = edge.start - edge.centre;
    const Vec2d b = edge.end - edge.centre;
    return std::abs(elementary::atan2(cross(a, b), dot(a, b)));
}

double length(const Edge& edge)
{
    return edge.turn == 0 ? distance(edge.start, edge.end) : edge.radius * sweep(edge);
}

Vec2d point_on(const Edge& edge, double share)
{
    if (edge.turn == 0) {
        return edge.start + (edge.end - edge.start) * share;
    }
    const double angle = sweep(edge) * share * edge.turn;
    const Vec2d arm = edge.start - edge.centre;
    return edge.centre + arm * elementary::cos(angle) + left_normal(arm) * elementary::sin(angle);
}

Vec2d tangent_on(const Edge& edge, double share)
{
    if (edge.turn == 0) {
        return unit(edge.end - edge.start);
    }
    return left_normal(unit(point_on(edge, share) - edge.centre)) * edge.turn;
}

Vec2d nearest_on(const Edge& edge, Vec2d point)
{
    if (edge.turn == 0) {
        const Vec2d along = edge.end - edge.start;
        const double square = dot(along, along);
        const double share = square > 0.0 ? dot(point - edge.start, along) / square : 0.0;
        return edge.start + along * std::clamp(share, 0.0, 1.0);
    }
    if (in_wedge(edge, point)) {
        const Vec2d arm = unit(point - edge.centre);
        if (dot(arm, arm) > 0.0) {
            return edge.centre + arm * edge.radius;
        }
    }
    const bool first = distance(point, edge.start) <= distance(point, edge.end);
    return first ? edge.start : edge.end;
}

double distance_to(const Edge& edge, Vec2d point)
{
    if (edge.turn != 0 && in_wedge(edge, point)) {
        return std::abs(distance(point, edge.centre) - edge.radius);
    }
    if (edge.turn == 0) {
        return distance(nearest_on(edge, point), point);
    }
    return std::min(distance(point, edge.start), distance(point, edge.end));
}

Edge reversed(const Edge& edge)
{
    return {edge.end, edge.start, edge.centre, edge.radius, -edge.turn};
}

Edge between(const Edge& edge, Vec2d from, Vec2d to)
{
    return {from, to, edge.centre, edge.radius, edge.turn};
}

std::vector<Edge> pieces_of(const Edge& edge, double most)
{
    const int n = std::max(1, static_cast<int>(std::ceil(length(edge) / most)));
    std::vector<Edge> pieces;
    for (int i = 0; i < n; ++i) {
        pieces.push_back(
            between(edge, point_on(edge, static_cast<double>(i) / n),
                    i + 1 == n ? edge.end : point_on(edge, static_cast<double>(i + 1) / n)));
    }
    return pieces;
}

double length(const Contour& contour)
{
    double sum = 0.0;
    for (const Edge& edge : contour) {
        sum += length(edge);
    }
    return sum;
}

double area(const Contour& contour)
{
    double twice = 0.0;
    const Vec2d origin = contour.empty() ? Vec2d{} : contour.front().start;
    for (const Edge& edge : contour) {
        twice += cross(edge.start - origin, edge.end - origin);
        if (edge.turn != 0) {
            const double angle = sweep(edge);
            twice += edge.turn * edge.radius * edge.radius * (angle - elementary::sin(angle));
        }
    }
    return 0.5 * twice;
}

double area(const Region2d& region)
{
    double sum = 0.0;
    for (const Contour& contour : region.contours) {
        sum += area(contour);
    }
    return sum;
}

Contour reversed(const Contour& contour)
{
    Contour result;
    result.reserve(contour.size());
    std::for_each(contour.rbegin(), contour.rend(),
                  [&](const Edge& edge) { result.push_back(reversed(edge)); });
    return result;
}

// The crossing of the ray with the chord, corrected if the point lies in the circular segment.
bool crossed_by_ray(const Edge& edge, Vec2d point)
{
    const bool rises = edge.end.y > point.y;
    const bool straddles = (edge.start.y > point.y) != rises;
    const double side = side_of_chord(edge, straddles, point);
    const bool by_chord = straddles && (side > 0.0) == rises;
    // Below half a turn a segment lies in the circle over its chord. The side of an arc of zero
    // length would be rounding.
    const bool in_segment = edge.turn != 0 && side * edge.turn < 0.0 &&
                            dot(point - edge.start, point - edge.end) <= 0.0 &&
                            distance(point, edge.centre) < edge.radius;
    return by_chord != in_segment;
}

bool surrounds(const Contour& contour, Vec2d point)
{
    bool inside = false;
    for (const Edge& edge : contour) {
        inside ^= crossed_by_ray(edge, point);
    }
    return inside;
}

bool contains(const Region2d& region, Vec2d point)
{
    bool inside = false;
    for (const Contour& contour : region.contours) {
        inside ^= surrounds(contour, point);
    }
    return inside;
}

double distance_to(const Region2d& region, Vec2d point)
{
    double best = kUnbounded;
    for (const Contour& contour : region.contours) {
        for (const Edge& edge : contour) {
            best = std::min(best, distance_to(edge, point));
        }
    }
    return best;
}

Box2d box_of(const Edge& edge)
{
    Box2d box{std::min(edge.start.x, edge.end.x), std::min(edge.start.y, edge.end.y),
              std::max(edge.start.x, edge.end.x), std::max(edge.start.y, edge.end.y)};
    if (edge.turn != 0) {
        const Vec2d c = edge.centre;
        const double r = edge.radius;
        if (in_wedge(edge, {c.x + r, c.y})) {
            box.x1 = c.x + r;
        }
        if (in_wedge(edge, {c.x - r, c.y})) {
            box.x0 = c.x - r;
        }
        if (in_wedge(edge, {c.x, c.y + r})) {
            box.y1 = c.y + r;
        }
        if (in_wedge(edge, {c.x, c.y - r})) {
            box.y0 = c.y - r;
        }
    }
    return box;
}

Box2d box_of(const Region2d& region)
{
    Box2d box;
    for (const Contour& contour : region.contours) {
        for (const Edge& edge : contour) {
            const Box2d b = box_of(edge);
            box = {std::min(box.x0, b.x0), std::min(box.y0, b.y0), std::max(box.x1, b.x1),
                   std::max(box.y1, b.y1)};
        }
    }
    return box;
}

std::vector<Edge> edges_of(const Region2d& region)
{
    std::vector<Edge> edges;
    for (const Contour& contour : region.contours) {
        edges.insert(edges.end(), contour.begin(), contour.end());
    }
    return edges;
}

std::vector<RegionPart> connected_parts(const Region2d& region)
{
    std::vector<RegionPart> parts;
    std::vector<double> areas;
    for (std::size_t i = 0; i < region.contours.size(); ++i) {
        areas.push_back(area(region.contours[i]));
        if (areas.back() > 0.0) {
            parts.push_back({i, {}});
        }
    }
    for (std::size_t i = 0; i < region.contours.size(); ++i) {
        if (areas[i] > 0.0) {
            continue;
        }
        const Vec2d probe = point_on(region.contours[i].front(), 0.5);
        RegionPart* home = nullptr;
        for (RegionPart& part : parts) {
            const bool tighter = home == nullptr || areas[part.outer] < areas[home->outer];
            if (tighter && surrounds(region.contours[part.outer], probe)) {
                home = &part;
            }
        }
        if (home != nullptr) {
            home->holes.push_back(i);
        }
    }
    return parts;
}

}  // namespace cusp::offset
