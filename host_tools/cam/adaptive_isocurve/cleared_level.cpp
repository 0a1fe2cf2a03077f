// Points of a raster have a pass near enough; parts of a line are shorter than the room at their ends.
#include "host_tools/cam/adaptive_isocurve/cleared_level.hpp"

#include <algorithm>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::adaptive_isocurve {

using clearing::ClearedRegion;
using clearing::ClearingPass;
using offset::Box2d;
using offset::Edge;
using offset::EdgeTree;
using offset::length;
using offset::Region2d;
using offset::RegionOffset;

namespace {

struct PartOfEdge {
    double from;
    double to;
};

// Divided until the distance of the middle decides.
bool part_comes_near(const Box2d& box, const Edge& edge, double distance_to_box, PartOfEdge part)
{
    constexpr double kShort = 5e-4;  // mm
    const double middle = 0.5 * (part.from + part.to);
    const double half = 0.5 * (part.to - part.from) * length(edge);
    const double room = distance(box, point_on(edge, middle)) - distance_to_box;
    if (room >= half) {
        return false;
    }
    return room < 0 || half < kShort ||
           part_comes_near(box, edge, distance_to_box, {part.from, middle}) ||
           part_comes_near(box, edge, distance_to_box, {middle, part.to});
}

}  // namespace

bool covers(const ClearedRegion& cleared, const Region2d& region, double step, const Box2d& box)
{
    constexpr double kReach = 0.55;   // of the stepover; planned is a half
    constexpr double kAtEdge = 4e-3;  // mm
    std::vector<Edge> edges;
    for (const ClearingPass& pass : cleared.passes) {
        edges.insert(edges.end(), pass.path.begin(), pass.path.end());
    }
    const EdgeTree passes{edges};
    const RegionOffset inside{region};
    const double pitch = 0.4 * step;
    for (double x = box.x0; x <= box.x1; x += pitch) {
        for (double y = box.y0; y <= box.y1; y += pitch) {
            const Vec2d at{x, y};
            if (inside.clearance(at) > kAtEdge &&
                (edges.empty() || !passes.any_nearer(at, kReach * step))) {
                return false;
            }
        }
    }
    return true;
}

double distance(const Box2d& box, Vec2d place)
{
    return elementary::hypot(std::max({box.x0 - place.x, place.x - box.x1, 0.0}),
                             std::max({box.y0 - place.y, place.y - box.y1, 0.0}));
}

bool comes_near(const Box2d& box, const Edge& edge, double distance_to_box)
{
    return part_comes_near(box, edge, distance_to_box, {0.0, 1.0});
}

// Divided until the clearances at both ends of each part are together at least its length.
bool line_inside(const RegionOffset& region, Vec2d from, Vec2d to, double radius)
{
    constexpr double kShort = 2e-3;  // mm: outside by no more than the tolerance of chords
    const double room_from = region.clearance(from) - radius;
    const double room_to = region.clearance(to) - radius;
    const double length = norm(to - from);
    if (room_from < 0 || room_to < 0) {
        return false;
    }
    if (room_from + room_to >= length || length < kShort) {
        return true;
    }
    const Vec2d middle = (from + to) * 0.5;
    return line_inside(region, from, middle, radius) && line_inside(region, middle, to, radius);
}

bool line_inside(const RegionOffset& region, const std::vector<Edge>& way)
{
    return std::all_of(way.begin(), way.end(), [&](const Edge& edge) {
        const int parts = edge.turn == 0 ? 1 : 1 + static_cast<int>(sweep(edge) / 0.02);
        for (int k = 0; k < parts; ++k) {
            const Vec2d from = point_on(edge, static_cast<double>(k) / parts);
            const Vec2d to = point_on(edge, static_cast<double>(k + 1) / parts);
            if (!line_inside(region, from, to)) {
                return false;
            }
        }
        return true;
    });
}

}  // namespace cusp::adaptive_isocurve
