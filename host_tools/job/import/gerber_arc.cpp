// Centres are rounded in files: they are moved along the chord.
#include "host_tools/job/import/gerber_arc.hpp"

#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::import {

CircularWay way_of(const GerberArc& arc)
{
    Vec2d centre = arc.from + arc.centre;
    const bool closed = norm(arc.to - arc.from) < offset::kSamePoint;
    if (!closed) {
        const Vec2d along = offset::unit(arc.to - arc.from);
        centre = centre - along * dot(centre - 0.5 * (arc.from + arc.to), along);
    }
    const Vec2d out = arc.from - centre;
    CircularWay way{centre, norm(out), elementary::atan2(out.y, out.x), 2 * kPi};
    if (!closed) {
        way.sweep = elementary::atan2(arc.to.y - centre.y, arc.to.x - centre.x) - way.start;
        way.sweep += way.sweep <= 0 ? 2 * kPi : 0;
    }
    if (!arc.counter_clockwise) {
        way.sweep = closed ? -way.sweep : way.sweep - 2 * kPi;
    }
    return way;
}

std::optional<CircularWay> quarter_way(const GerberArc& arc)
{
    constexpr double kSlack = 1e-3;  // radians
    std::optional<CircularWay> best;
    double least = kUnbounded;
    if (norm(arc.to - arc.from) < offset::kSamePoint) {
        return best;
    }
    for (const int x : {1, -1}) {
        for (const int y : {1, -1}) {
            GerberArc signed_arc = arc;
            signed_arc.centre = {x * std::fabs(arc.centre.x), y * std::fabs(arc.centre.y)};
            const Vec2d centre = arc.from + signed_arc.centre;
            const CircularWay way = way_of(signed_arc);
            const double off = std::fabs(norm(arc.to - centre) - norm(arc.from - centre));
            if (std::fabs(way.sweep) < kPi / 2 + kSlack && off < least) {
                least = off;
                best = way;
            }
        }
    }
    return best;
}

}  // namespace cusp::import
