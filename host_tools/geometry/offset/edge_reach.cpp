// Discs and bands, edge by edge.
#include "host_tools/geometry/offset/edge_reach.hpp"

namespace cusp::offset {

namespace {

Contour disc(Vec2d centre, double radius)
{
    Contour contour;
    Vec2d arm{radius, 0.0};
    for (int quarter = 0; quarter < 4; ++quarter) {
        contour.push_back({centre + arm, centre + left_normal(arm), centre, radius, 1});
        arm = left_normal(arm);
    }
    return contour;
}

Contour band(const Edge& edge, double distance)
{
    if (edge.turn < 0) {
        return band(reversed(edge), distance);
    }
    const auto beside = [&](Vec2d point, double by) {
        const Vec2d right = edge.turn == 0 ? left_normal(unit(edge.end - edge.start)) * -1.0
                                           : unit(point - edge.centre);
        return point + right * by;
    };
    const Vec2d out_start = beside(edge.start, distance);
    const Vec2d out_end = beside(edge.end, distance);
    const double inner = edge.radius - distance;
    const bool closes = edge.turn != 0 && inner <= kSamePoint;
    const Vec2d in_start = closes ? edge.centre : beside(edge.start, -distance);
    const Vec2d in_end = closes ? edge.centre : beside(edge.end, -distance);
    Contour contour{{out_start, out_end, edge.centre, edge.radius + distance, edge.turn},
                    line_edge(out_end, in_end)};
    if (!closes) {
        contour.push_back({in_end, in_start, edge.centre, inner, -edge.turn});
    }
    contour.push_back(line_edge(in_start, out_start));
    return contour;
}

}  // namespace

Region2d edge_reach(const Region2d& region, double distance)
{
    Region2d reach;
    for (const Contour& contour : region.contours) {
        for (const Edge& edge : contour) {
            reach.contours.push_back(disc(edge.start, distance));
            reach.contours.push_back(band(edge, distance));
        }
    }
    return reach;
}

}  // namespace cusp::offset
