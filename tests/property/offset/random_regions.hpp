// Random regions of lines and arcs with islands, from a seed.
#pragma once

#include <random>

#include "host_tools/offset/contour.hpp"

namespace cusp::host {

using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high)
{
    return std::uniform_real_distribution<double>{low, high}(random);
}

// A line, or an arc of the given bulge (a quarter of the sweep's tangent) between two points.
inline Edge bulged(Vec2d a, Vec2d b, double bulge)
{
    if (std::abs(bulge) < 1e-3) {
        return line_edge(a, b);
    }
    const Vec2d chord = b - a;
    // Centre left of the chord for a counter-clockwise arc below half a turn.
    const double height = (1.0 - bulge * bulge) / (4.0 * bulge);
    return arc_edge(a, b, (a + b) * 0.5 + left_normal(chord) * height, bulge > 0.0 ? 1 : -1);
}

// A star-shaped contour about a centre: some corners, some lines, some arcs bent either way. A grid
// makes parallel, equal and coincident distances likely.
inline Contour random_star(Random& random, Vec2d centre, double radius, int corners, double grid)
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
    Contour contour;
    for (int i = 0; i < corners; ++i) {
        const Vec2d a = points[static_cast<std::size_t>(i)];
        const Vec2d b = points[static_cast<std::size_t>((i + 1) % corners)];
        const double bulge = uniform(random, 0.0, 1.0) < 0.5 ? 0.0 : uniform(random, -0.25, 0.45);
        contour.push_back(bulged(a, b, bulge));
    }
    return contour;
}

inline std::vector<Vec2d> samples(const Contour& contour, int each)
{
    std::vector<Vec2d> points;
    for (const Edge& edge : contour) {
        for (int i = 0; i < each; ++i) {
            points.push_back(point_on(edge, static_cast<double>(i) / each));
        }
    }
    return points;
}

}  // namespace cusp::host
