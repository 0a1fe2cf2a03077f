// A point counts if it is deeper than those before it: the order of the grid decides between equals.
#include "host_tools/cam/adaptive_clearing/deepest_place.hpp"

#include <algorithm>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::adaptive_clearing {

using offset::Box2d;
using offset::box_of;
using offset::Contour;
using offset::Region2d;
using offset::RegionOffset;
using offset::RegionPart;
using offset::surrounds;

bool is_inside(const Region2d& region, const RegionPart& part, Vec2d point)
{
    return surrounds(region.contours[part.outer], point) &&
           std::none_of(part.holes.begin(), part.holes.end(),
                        [&](std::size_t k) { return surrounds(region.contours[k], point); });
}

Vec2d deepest_place(const Region2d& region, const RegionPart& part, const RegionOffset& walls)
{
    constexpr int kGrid = 48;
    const Contour& outer = region.contours[part.outer];
    const Box2d box = box_of(Region2d{{outer}});
    Vec2d best = outer.front().start;
    double most = walls.nearest(best, kUnbounded);
    for (int j = 0; j < kGrid; ++j) {
        for (int i = 0; i < kGrid; ++i) {
            const Vec2d p{box.x0 + (box.x1 - box.x0) * (i + 0.5) / kGrid,
                          box.y0 + (box.y1 - box.y0) * (j + 0.5) / kGrid};
            const double d = walls.nearest(p, kUnbounded);
            if (d > most && is_inside(region, part, p)) {
                best = p;
                most = d;
            }
        }
    }
    return best;
}

Vec2d deepest_near(Vec2d place, double step, const RegionOffset& walls)
{
    constexpr int kWays = 8;
    constexpr double kFinest = 0.002;
    Vec2d deepest = place;
    double best = walls.nearest(place, kUnbounded);
    for (const double least = kFinest * step; step > least;) {
        const Vec2d from = deepest;
        bool found = false;
        for (int i = 0; i < kWays; ++i) {
            const double angle = 2.0 * kPi * i / kWays;
            const Vec2d to = from + Vec2d{elementary::cos(angle), elementary::sin(angle)} * step;
            const double room = walls.nearest(to, kUnbounded);
            if (room > best && walls.contains(to)) {
                best = room;
                deepest = to;
                found = true;
            }
        }
        step = found ? step : 0.5 * step;
    }
    return deepest;
}

}  // namespace cusp::adaptive_clearing
