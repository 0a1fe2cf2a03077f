// Judges an offset by brute-force distance and by Clipper.
#pragma once

#include <algorithm>
#include <cmath>
#include <polyclipping/clipper.hpp>

#include "tests/generators/random_regions.hpp"

namespace cusp::test {

// True if the point is on the left of the contours nearest to it.
//
// unbounded  the region is all that the contours do not enclose
inline bool belongs(const offset::Region2d& region, Vec2d p, bool unbounded)
{
    return offset::contains(region, p) != unbounded;
}

// Largest departure of the result's points from the distance asked for; wrong side counts as 1.
inline double worst_distance(const offset::Region2d& source,
                             const offset::Region2d& result,
                             double distance,
                             bool unbounded = false)
{
    double worst = 0.0;
    for (const offset::Contour& contour : result.contours) {
        for (const Vec2d p : samples(contour, 5)) {
            worst = std::max(worst, std::abs(offset::distance_to(source, p) - distance));
            if (!belongs(source, p, unbounded)) {
                worst = std::max(worst, 1.0);
            }
        }
        for (std::size_t i = 0; i < contour.size(); ++i) {
            const Vec2d next = contour[(i + 1) % contour.size()].start;
            worst = std::max(worst, offset::distance(contour[i].end, next));
        }
    }
    return worst;
}

// Random points up to `reach` beyond the box of the source whose membership of the result differs from their distance.
inline int wrong_points(Random& random,
                        const offset::Region2d& source,
                        const offset::Region2d& result,
                        double distance,
                        double reach = 5.0,
                        bool unbounded = false)
{
    const offset::Box2d box = offset::box_of(source);
    int wrong = 0;
    for (int i = 0; i < 60; ++i) {
        const Vec2d p{uniform(random, box.x0 - reach, box.x1 + reach),
                      uniform(random, box.y0 - reach, box.y1 + reach)};
        const double apart = offset::distance_to(source, p);
        if (std::abs(apart - distance) > 1e-5) {
            const bool expected = belongs(source, p, unbounded) && apart > distance;
            wrong += belongs(result, p, unbounded) != expected ? 1 : 0;
        }
    }
    return wrong;
}

inline constexpr double kClipperUnit = 1e6;

inline ClipperLib::Paths polygons(const offset::Region2d& region)
{
    ClipperLib::Paths paths;
    for (const offset::Contour& contour : region.contours) {
        ClipperLib::Path path;
        for (const offset::Edge& edge : contour) {
            const int n = edge.turn == 0 ? 1 : 64;
            for (int i = 0; i < n; ++i) {
                const Vec2d p = offset::point_on(edge, static_cast<double>(i) / n);
                path.emplace_back(static_cast<ClipperLib::cInt>(std::llround(p.x * kClipperUnit)),
                                  static_cast<ClipperLib::cInt>(std::llround(p.y * kClipperUnit)));
            }
        }
        paths.push_back(path);
    }
    return paths;
}

inline double clipper_area(const offset::Region2d& source, double distance)
{
    ClipperLib::ClipperOffset kernel{2.0, 1e-3 * kClipperUnit};
    kernel.AddPaths(polygons(source), ClipperLib::jtRound, ClipperLib::etClosedPolygon);
    ClipperLib::Paths result;
    kernel.Execute(result, -distance * kClipperUnit);
    double sum = 0.0;
    for (const ClipperLib::Path& path : result) {
        sum += ClipperLib::Area(path);
    }
    return sum / (kClipperUnit * kClipperUnit);
}

}  // namespace cusp::test
