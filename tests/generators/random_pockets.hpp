// Random pockets of six kinds over random floors, from a seed.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "host_tools/cam/grid_pocket/grid_pocket.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "tests/generators/random_jobs.hpp"
#include "tests/support/loops.hpp"

namespace cusp::test {

using Polygon = std::vector<Vec2d>;

inline Polygon star_polygon(Random& random, double inner, double outer, int corners)
{
    Polygon out;
    for (int i = 0; i < corners; ++i) {
        const double angle = 6.283185307179586 * (i + uniform(random, -0.3, 0.3)) / corners;
        out.push_back(Vec2d{std::cos(angle), std::sin(angle)} * uniform(random, inner, outer));
    }
    return out;
}

inline Polygon convex_polygon(Random& random, double radius, int corners)
{
    std::vector<double> angles;
    for (int i = 0; i < corners; ++i) {
        angles.push_back(6.283185307179586 * (i + uniform(random, 0.0, 0.9)) / corners);
    }
    const double width = radius * uniform(random, 0.6, 1.0);
    Polygon out;
    for (const double angle : angles) {
        out.push_back({radius * std::cos(angle), width * std::sin(angle)});
    }
    return out;
}

// A band of even width along a spiral.
inline Polygon spiral_polygon(Random& random, double width)
{
    const double pitch = width * uniform(random, 1.25, 1.8);
    const double turns = uniform(random, 1.0, 1.7);
    const int count = static_cast<int>(40 * turns);
    Polygon outer;
    Polygon inner;
    for (int i = 0; i <= count; ++i) {
        const double angle = 6.283185307179586 * turns * i / count;
        const double r = width + pitch * angle / 6.283185307179586;
        const Vec2d way{std::cos(angle), std::sin(angle)};
        outer.push_back(way * (r + width / 2));
        inner.push_back(way * (r - width / 2));
    }
    outer.insert(outer.end(), inner.rbegin(), inner.rend());
    return outer;
}

// Two rooms joined by a neck.
inline Polygon neck_polygon(Random& random, double room, double neck, double apart)
{
    const double a = uniform(random, -3.0, 3.0);
    const double b = a + uniform(random, -2.0, 2.0);
    return {{-apart - room, -room},        {-apart + room, -room}, {-apart + room, a - neck / 2},
            {apart - room, b - neck / 2},  {apart - room, -room},  {apart + room, -room},
            {apart + room, room},          {apart - room, room},   {apart - room, b + neck / 2},
            {-apart + room, a + neck / 2}, {-apart + room, room},  {-apart - room, room}};
}

// Fingers on a base.
inline Polygon comb_polygon(Random& random, int fingers, double width, double gap)
{
    const double base = 8;
    double x = fingers * width + (fingers - 1) * gap;
    Polygon out{{0, 0}, {x, 0}};
    for (int i = 0; i < fingers; ++i) {
        const double height = base + uniform(random, 6.0, 20.0);
        out.push_back({x, height});
        out.push_back({x - width, height});
        x -= width;
        if (i + 1 < fingers) {
            out.push_back({x, base});
            out.push_back({x - gap, base});
            x -= gap;
        }
    }
    return out;
}

inline Polygon random_polygon(Random& random, double radius)
{
    switch (whole(random, 0, 5)) {
        case 0:
            return convex_polygon(random, uniform(random, 14.0, 30.0), whole(random, 3, 9));
        case 1:
            return star_polygon(random, uniform(random, 9.0, 14.0), uniform(random, 18.0, 30.0),
                                whole(random, 5, 14));
        case 2:
            return spiral_polygon(random, 2 * radius * uniform(random, 1.4, 2.4));
        case 3:
            return neck_polygon(random, uniform(random, 9.0, 14.0),
                                2 * radius * uniform(random, 0.8, 1.6),
                                uniform(random, 15.0, 20.0));
        case 4:
            return comb_polygon(random, whole(random, 2, 4), 2 * radius * uniform(random, 1.2, 1.9),
                                uniform(random, 1.0, 5.0));
        default:
            return star_polygon(random, 18.0, 22.0, whole(random, 60, 200));
    }
}

inline offset::Box2d grown_box(const Polygon& polygon, double by)
{
    offset::Box2d box;
    for (const Vec2d p : polygon) {
        box = {std::min(box.x0, p.x), std::min(box.y0, p.y), std::max(box.x1, p.x),
               std::max(box.y1, p.y)};
    }
    return {box.x0 - by, box.y0 - by, box.x1 + by, box.y1 + by};
}

// A job of one grid_pocket operation.
inline job::Job random_pocket(Random& random)
{
    job::Operation operation;
    operation.strategy = &cusp::grid_pocket::kGridPocket;
    operation.tool = random_tool(random);
    const double radius = operation.tool.radius;
    const Polygon polygon = random_polygon(random, radius);
    operation.outline.boundary = loop_of(polygon);
    constexpr double kRough[]{0.0, 0.5, 1.0, 2.0, 3.0};
    const double rough = kRough[whole(random, 0, 4)];
    operation.part.floor = {random_floor(random, grown_box(polygon, 2 * radius + 1), -10, rough)};
    if (whole(random, 0, 4) == 0) {
        operation.part.floor.push_back(
            random_floor(random, grown_box(polygon, 2 * radius + 1), -10, rough));
    }
    const double coarsest = 2 * radius / std::sqrt(2.0);
    cusp::grid_pocket::grid_keys(operation).grid_x = coarsest * uniform(random, 0.25, 1.0);
    cusp::grid_pocket::grid_keys(operation).grid_y = coarsest * uniform(random, 0.25, 1.0);
    operation.tolerance.plan = operation.tolerance.floor =
        cusp::grid_pocket::grid_keys(operation).arc_tolerance = uniform(random, 0.01, 0.05);
    operation.output = whole(random, 0, 1) == 0 ? job::OutputForm::kLines : job::OutputForm::kArcs;
    constexpr job::EntryKind kEntries[]{job::EntryKind::kAuto, job::EntryKind::kHelix,
                                        job::EntryKind::kRamp, job::EntryKind::kPlunge};
    operation.passes.entry = kEntries[whole(random, 0, 3)];
    if (whole(random, 0, 1) == 0) {
        cusp::grid_pocket::grid_keys(operation).zigzag.push_back('x');
    }
    if (whole(random, 0, 1) == 0) {
        cusp::grid_pocket::grid_keys(operation).zigzag.push_back('y');
    }
    if (whole(random, 0, 2) != 0) {
        operation.levels.max_depth = uniform(random, 1.5, 4.0);
    }
    operation.passes.allowance = whole(random, 0, 2) == 0 ? 0.3 : 0.0;
    return job_of(operation);
}

// True if all of the island is at least half a millimetre inside the boundary.
inline bool island_fits(const Polygon& boundary, const Polygon& island)
{
    constexpr double kApart = 0.5;  // mm
    offset::Contour contour;
    for (std::size_t i = 0; i < boundary.size(); ++i) {
        contour.push_back(offset::line_edge(boundary[i], boundary[(i + 1) % boundary.size()]));
    }
    const offset::RegionOffset region{{{contour}}};
    for (std::size_t i = 0; i < island.size(); ++i) {
        const Vec2d way = island[(i + 1) % island.size()] - island[i];
        const int pieces = 1 + static_cast<int>(norm(way) / kApart);
        for (int k = 0; k < pieces; ++k) {
            if (region.clearance(island[i] + way * (static_cast<double>(k) / pieces)) < kApart) {
                return false;
            }
        }
    }
    return true;
}

// The same, cleared in layers of bounded engagement, half of them with an island.
inline job::Job random_adaptive_pocket(Random& random)
{
    job::Job job = random_pocket(random);
    job::Operation& operation = job.operations.front();
    operation.passes.max_engagement = uniform(random, 40.0, 100.0);
    operation.levels.max_depth = uniform(random, 1.5, 4.0);
    if (whole(random, 0, 1) == 0) {
        Polygon boundary;
        for (const nurbs::Curve& side : *operation.outline.boundary) {
            boundary.push_back({side.points.front().x, side.points.front().y});
        }
        const Polygon island = star_polygon(random, 2.0, 6.0, whole(random, 3, 9));
        if (island_fits(boundary, island)) {
            operation.outline.islands.push_back(loop_of(island));
            operation.outline.island_files.emplace_back("island");
        }
    }
    return job;
}

}  // namespace cusp::test
