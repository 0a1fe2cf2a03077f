// Contours first, then a lattice between them.
#include "host_tools/clearing/floor_coverage.hpp"

#include <algorithm>

#include "host_tools/offset/edge_tree.hpp"

namespace cusp::host {
namespace {

std::optional<Vec2d> uncovered_inside(const Region2d& region,
                                      const TipFloor& floor,
                                      double tool_radius)
{
    constexpr double kMostPlaces = 250.0;  // a side
    const Box2d box = box_of(region);
    const double longest = std::max(box.x1 - box.x0, box.y1 - box.y0);
    const double spacing = std::max(0.25 * tool_radius, longest / kMostPlaces);
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

}  // namespace

std::optional<Vec2d> uncovered_place(const Region2d& region,
                                     const TipFloor& floor,
                                     double tool_radius,
                                     bool inside)
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
    return inside ? uncovered_inside(region, floor, tool_radius) : std::nullopt;
}

}  // namespace cusp::host
