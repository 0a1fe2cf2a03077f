// Edges become chords on a grid, chords a planar subdivision, and its border edges again.
#include "host_tools/geometry/offset/region_overlay.hpp"

#include <algorithm>

#include "host_tools/geometry/offset/chord_chains.hpp"
#include "host_tools/geometry/offset/edge_runs.hpp"
#include "host_tools/geometry/offset/winding_border.hpp"

namespace cusp::offset {

namespace {

// True if both are parts of one edge, with nothing else at the vertex between.
bool goes_on(const BorderPart& part, const BorderPart& next)
{
    return !next.pinched && part.segment.source == next.segment.source &&
           part.backwards == next.backwards;
}

// The part of an edge between two points that lie on it nearly. An arc goes through both: short ones
// would else turn aside, or end elsewhere.
Edge part_through(const Edge& edge, Vec2d from, Vec2d to)
{
    const Edge part = between(edge, from, to);
    const double size = distance(from, to);
    const double off = std::max(std::abs(distance(from, edge.centre) - edge.radius),
                                std::abs(distance(to, edge.centre) - edge.radius));
    if (edge.turn == 0 || off <= 1e-9 * size || size == distance(edge.start, edge.end)) {
        return part;
    }
    const double square = edge.radius * edge.radius - 0.25 * size * size;
    if (square <= 0.0) {
        return line_edge(from, to);
    }
    const Vec2d aside = left_normal(unit(to - from)) * (edge.turn * std::sqrt(square));
    return {from, to, (from + to) * 0.5 + aside, edge.radius, edge.turn};
}

Contour contour_of(std::vector<BorderPart> loop,
                   const std::vector<Edge>& edges,
                   const GridPoints& points)
{
    for (std::size_t i = 0; i < loop.size(); ++i) {
        if (!goes_on(i == 0 ? loop.back() : loop[i - 1], loop[i])) {
            std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(i), loop.end());
            break;
        }
    }
    Contour contour;
    for (std::size_t i = 0; i < loop.size();) {
        const BorderPart& first = loop[i];
        const std::size_t begin = i;
        for (++i; i < loop.size() && goes_on(loop[begin], loop[i]); ++i) {
        }
        Edge edge = edges[first.segment.source];
        edge = first.backwards ? reversed(edge) : edge;
        const Vec2d from = points.place(first.segment.from);
        const Vec2d to = points.place(loop[i - 1].segment.to);
        contour.push_back(part_through(edge, from, to));
    }
    const auto least =
        std::min_element(contour.begin(), contour.end(),
                         [](const Edge& a, const Edge& b) { return a.start.x < b.start.x; });
    std::rotate(contour.begin(), least, contour.end());
    return contour;
}

Region2d overlay(const Region2d& a, const Region2d& b, bool (*is_in)(Windings))
{
    std::vector<Edge> edges = edges_of(a);
    const std::size_t first_of_b = edges.size();
    const std::vector<Edge> more = edges_of(b);
    edges.insert(edges.end(), more.begin(), more.end());
    Box2d box;
    for (const Edge& edge : edges) {
        const Box2d by = box_of(edge);
        box = {std::min(box.x0, by.x0), std::min(box.y0, by.y0), std::max(box.x1, by.x1),
               std::max(box.y1, by.y1)};
    }
    GridPoints points{box};
    std::vector<Segment> segments = chord_chains(edges, points);
    make_planar(segments, points);
    Region2d region;
    for (auto& loop : winding_border(segments, points, first_of_b, is_in)) {
        Contour contour = contour_of(std::move(loop), edges, points);
        if (std::abs(area(contour)) > kSameVertex * length(contour)) {
            region.contours.push_back(std::move(contour));
        }
    }
    return region;
}

}  // namespace

Region2d common(const Region2d& a, const Region2d& b)
{
    return overlay(a, b, [](Windings w) { return w[0] > 0 && w[1] > 0; });
}

Region2d united(const Region2d& a, const Region2d& b)
{
    return overlay(a, b, [](Windings w) { return w[0] > 0 || w[1] > 0; });
}

Region2d without(const Region2d& a, const Region2d& b)
{
    return overlay(a, b, [](Windings w) { return w[0] > 0 && w[1] <= 0; });
}

}  // namespace cusp::offset
