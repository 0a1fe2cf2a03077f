// Random regions of lines and arcs with islands, from a seed.
#pragma once

#include <algorithm>
#include <random>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/offset/region_check.hpp"

namespace cusp::test {

using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high)
{
    return std::uniform_real_distribution<double>{low, high}(random);
}

// A line, or an arc of the given bulge (a quarter of the sweep's tangent) between two points.
inline offset::Edge bulged(Vec2d a, Vec2d b, double bulge)
{
    if (std::abs(bulge) < 1e-3) {
        return offset::line_edge(a, b);
    }
    const Vec2d chord = b - a;
    // Centre left of the chord for a counter-clockwise arc below half a turn.
    const double height = (1.0 - bulge * bulge) / (4.0 * bulge);
    return offset::arc_edge(a, b, (a + b) * 0.5 + offset::left_normal(chord) * height,
                            bulge > 0.0 ? 1 : -1);
}

// A star-shaped contour about a centre: some corners, some lines, some arcs bent either way. A grid
// makes parallel, equal and coincident distances likely.
inline offset::Contour random_star(
    Random& random, Vec2d centre, double radius, int corners, double grid)
{
    std::vector<Vec2d> points;
    for (int i = 0; i < corners; ++i) {
        const double angle = 6.283185307179586 * (i + uniform(random, 0.1, 0.9)) / corners;
        const double r = radius * uniform(random, 0.45, 1.0);
        Vec2d p = centre + Vec2d{std::cos(angle), std::sin(angle)} * r;
        if (grid > 0.0) {
            p = {std::round(p.x / grid) * grid, std::round(p.y / grid) * grid};
        }
        points.push_back(p);
    }
    offset::Contour contour;
    for (int i = 0; i < corners; ++i) {
        const Vec2d a = points[static_cast<std::size_t>(i)];
        const Vec2d b = points[static_cast<std::size_t>((i + 1) % corners)];
        const double bulge = uniform(random, 0.0, 1.0) < 0.5 ? 0.0 : uniform(random, -0.25, 0.45);
        contour.push_back(bulged(a, b, bulge));
    }
    return contour;
}

struct RegionSize {
    double scale{1.0};   // of 120 mm
    double corners{12};  // below this
    double islands{4};   // likewise
};

// A star with islands, none of which cross.
inline offset::Region2d random_region(Random& random, RegionSize size = {})
{
    const double scale = size.scale;
    const double least_area = scale * scale;
    const double grid = uniform(random, 0.0, 1.0) < 0.3 ? 5.0 * scale : 0.0;
    while (true) {
        offset::Region2d region;
        const int corners = static_cast<int>(uniform(random, 3.0, size.corners));
        region.contours.push_back(random_star(random, {0.0, 0.0}, 60.0 * scale, corners, grid));
        const int islands = static_cast<int>(uniform(random, 0.0, size.islands));
        for (int i = 0; i < islands; ++i) {
            const Vec2d centre =
                scale * Vec2d{uniform(random, -35.0, 35.0), uniform(random, -35.0, 35.0)};
            const int sides = static_cast<int>(uniform(random, 3.0, 7.0));
            region.contours.push_back(offset::reversed(
                random_star(random, centre, scale * uniform(random, 4.0, 14.0), sides, grid)));
        }
        const bool turned = std::any_of(region.contours.begin(), region.contours.end(),
                                        [&](const offset::Contour& contour) {
                                            const bool outer = &contour == &region.contours.front();
                                            return (offset::area(contour) > least_area) != outer ||
                                                   std::abs(offset::area(contour)) < least_area;
                                        });
        if (!turned && !find_fault(region)) {
            return region;
        }
    }
}

inline std::vector<Vec2d> samples(const offset::Contour& contour, int each)
{
    std::vector<Vec2d> points;
    for (const offset::Edge& edge : contour) {
        for (int i = 0; i < each; ++i) {
            points.push_back(point_on(edge, static_cast<double>(i) / each));
        }
    }
    return points;
}

}  // namespace cusp::test
