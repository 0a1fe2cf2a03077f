// Places are tried in the order of their distance.
#include "host_tools/cam/adaptive_clearing/sliver_moves.hpp"

#include <algorithm>
#include <utility>

#include "host_tools/cam/clearing/clear_path.hpp"

namespace cusp::adaptive_clearing {

using clearing::is_path_clear;
using offset::Edge;
using offset::length;
using offset::line_edge;

std::optional<Edge> move_to_sliver(Vec2d sliver, const SliverSpace& space)
{
    const double radius = space.tool_radius;
    std::vector<std::pair<double, Vec2d>> near;
    for (const Vec2d place : space.places) {
        const double d = norm(sliver - place);
        if (d < 2.0 * radius) {
            near.emplace_back(d, place);
        }
    }
    std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) {
        return a.first < b.first || (a.first == b.first && std::pair{a.second.x, a.second.y} <
                                                               std::pair{b.second.x, b.second.y});
    });
    for (const auto& [d, place] : near) {
        const Edge way = line_edge(place, sliver - (sliver - place) * (0.98 * radius / d));
        if (is_path_clear(space.walls, way, space.wall_clearance)) {
            return way;
        }
    }
    const Vec2d beside = space.centres.nearest_edge(sliver).point;
    if (norm(sliver - beside) >= 0.99 * radius) {
        return std::nullopt;
    }
    for (const auto& [d, place] : near) {
        const Edge way = line_edge(place, beside);
        if (length(way) > 0.0 && is_path_clear(space.walls, way, space.wall_clearance)) {
            return way;
        }
    }
    return std::nullopt;
}

}  // namespace cusp::adaptive_clearing
