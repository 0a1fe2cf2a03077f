// Samples the contours first, then a grid between them.
#include "host_tools/geometry/drop_cutter/floor_coverage.hpp"

#include <algorithm>

#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::drop_cutter {

using nurbs::Surface;
using offset::Box2d;
using offset::Contour;
using offset::Edge;
using offset::EdgeTree;
using offset::Region2d;

namespace {

std::optional<Vec2d> uncovered_inside(const Region2d& region,
                                      const DropCutter& floor,
                                      double tool_radius)
{
    constexpr double kMostSamples = 250.0;  // a side
    const Box2d box = box_of(region);
    const double longest = std::max(box.x1 - box.x0, box.y1 - box.y0);
    const double spacing = std::max(0.25 * tool_radius, longest / kMostSamples);
    const EdgeTree walls{edges_of(region)};
    for (double x = box.x0 + 0.5 * spacing; x < box.x1; x += spacing) {
        for (double y = box.y0 + 0.5 * spacing; y < box.y1; y += spacing) {
            if (!floor.covers({x, y}) && walls.surrounds({x, y})) {
                return Vec2d{x, y};
            }
        }
    }
    return std::nullopt;
}

// True if two opposite sides of the surface meet.
bool closes(const Surface& s)
{
    constexpr double kSame = 1e-3;  // mm
    constexpr int kSamples = 4;
    bool in_u = true;
    bool in_v = true;
    for (int k = 0; k <= kSamples; ++k) {
        const double t = static_cast<double>(k) / kSamples;
        const double u = s.u_begin() + (s.u_end() - s.u_begin()) * t;
        const double v = s.v_begin() + (s.v_end() - s.v_begin()) * t;
        in_u = in_u && norm(point_at(s, s.u_begin(), v) - point_at(s, s.u_end(), v)) < kSame;
        in_v = in_v && norm(point_at(s, u, s.v_begin()) - point_at(s, u, s.v_end())) < kSame;
    }
    return in_u || in_v;
}

bool may_have_gaps(const std::vector<Surface>& surfaces)
{
    return surfaces.size() != 1 || !surfaces.front().trims.empty() || closes(surfaces.front());
}

}  // namespace

std::optional<Vec2d> point_without_floor(const Region2d& region,
                                         const DropCutter& floor,
                                         const std::vector<Surface>& surfaces,
                                         double tool_radius)
{
    for (const Contour& contour : region.contours) {
        for (const Edge& edge : contour) {
            const int n = 1 + static_cast<int>(length(edge) / tool_radius);
            for (int i = 0; i < n; ++i) {
                const Vec2d p = point_on(edge, static_cast<double>(i) / n);
                if (!floor.covers(p)) {
                    return p;
                }
            }
        }
    }
    return may_have_gaps(surfaces) ? uncovered_inside(region, floor, tool_radius) : std::nullopt;
}

}  // namespace cusp::drop_cutter
