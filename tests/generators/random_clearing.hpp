// Settings, slots and ovals for adaptive clearing, from a seed.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/offset/region_check.hpp"
#include "tests/generators/random_regions.hpp"
#include "tests/unit/offset/polygons.hpp"

namespace cusp::test {

using namespace adaptive_clearing;
using namespace offset;

constexpr double kDegrees = 3.14159265358979323846 / 180.0;
constexpr double kTolerance = 0.005;  // mm

inline AdaptiveSettings random_settings(Random& random, unsigned number)
{
    AdaptiveSettings settings;
    settings.tool_radius = uniform(random, 2.0, 6.0);
    settings.wall_clearance = settings.tool_radius + uniform(random, 0.01, 0.3);
    settings.max_engagement = uniform(random, 35.0, 100.0) * kDegrees;
    settings.tolerance = kTolerance;
    settings.corner = 0.02;
    settings.direction =
        number % 2 == 0 ? job::CutDirection::kClimb : job::CutDirection::kConventional;
    return settings;
}

// One side of a slot along the way: its points moved by `aside` to the left.
inline std::vector<Vec2d> beside(const std::vector<Vec2d>& way, double aside)
{
    std::vector<Vec2d> side;
    for (std::size_t i = 0; i < way.size(); ++i) {
        const Vec2d before = unit(i > 0 ? way[i] - way[i - 1] : way[1] - way[0]);
        const Vec2d after = unit(i + 1 < way.size() ? way[i + 1] - way[i] : before);
        const Vec2d n = unit(left_normal(before) + left_normal(after));
        side.push_back(way[i] + n * (aside / dot(n, left_normal(before))));
    }
    return side;
}

// A bent slot that widens or narrows a little, with or without a room at each end.
inline std::optional<Region2d> random_slot(Random& random, const AdaptiveSettings& settings)
{
    const double radius = settings.tool_radius;
    const double half = settings.wall_clearance + radius * uniform(random, 0.03, 0.6);
    const double last_half = half + radius * uniform(random, -0.02, 0.2);
    std::vector<Vec2d> way{{0.0, 0.0}};
    double heading = uniform(random, 0.0, 6.28);
    for (int i = static_cast<int>(uniform(random, 1.0, 4.0)); i > 0; --i) {
        way.push_back(way.back() + Vec2d{std::cos(heading), std::sin(heading)} *
                                       (radius * uniform(random, 4.0, 9.0)));
        heading += uniform(random, -1.7, 1.7);
    }
    std::vector<Vec2d> outline = beside(way, -half);
    outline.back() = outline.back() + (way.back() - outline.back()) * (1.0 - last_half / half);
    std::vector<Vec2d> left = beside(way, half);
    left.back() = left.back() + (way.back() - left.back()) * (1.0 - last_half / half);
    const auto add_room = [&](Vec2d t, Vec2d right_end, Vec2d left_end) {
        if (uniform(random, 0.0, 1.0) < 0.5) {
            return;
        }
        const double aside = radius * uniform(random, 1.0, 3.0);
        const double deep = radius * uniform(random, 3.0, 6.0);
        const Vec2d n = left_normal(t);
        for (const Vec2d p : {right_end - n * aside, right_end - n * aside + t * deep,
                              left_end + n * aside + t * deep, left_end + n * aside}) {
            outline.push_back(p);
        }
    };
    add_room(unit(way.back() - way[way.size() - 2]), outline.back(), left.back());
    outline.insert(outline.end(), left.rbegin(), left.rend());
    add_room(unit(way[0] - way[1]), left.front(), outline.front());
    Region2d region;
    region.contours.emplace_back();
    for (std::size_t i = 0; i < outline.size(); ++i) {
        region.contours.front().push_back(line_edge(outline[i], outline[(i + 1) % outline.size()]));
    }
    return find_fault(region) || area(region) < 0.0 ? std::nullopt : std::optional{region};
}

// An oval of lines, with or without a part cut off by a chord.
inline Region2d random_oval(Random& random, const AdaptiveSettings& settings)
{
    constexpr int kSides = 60;
    const double half = settings.tool_radius * uniform(random, 4.0, 9.0);
    const double narrow = uniform(random, 0.65, 1.0);
    const double cut_off = uniform(random, 0.4, 1.6);
    std::vector<Vec2d> corners;
    for (int i = 0; i < kSides; ++i) {
        const double angle = 360.0 * kDegrees * i / kSides;
        corners.push_back(
            {half * std::min(std::cos(angle), cut_off), narrow * half * std::sin(angle)});
    }
    return {{polygon(corners)}};
}

}  // namespace cusp::test
