// The ends of the half turns lie on a line through the centre, on alternating sides.
#include "host_tools/adaptive_clearing/entry_spiral.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::adaptive_clearing {

using offset::arc_edge;
using offset::Edge;
using offset::point_on;
using offset::tangent_on;

namespace {

constexpr double kFirstTurn = 0.04;       // radii of the tool, at least
constexpr double kMissedBeside = 0.0004;  // radii, by SweptArea
constexpr double kMostGrowth = 1.6;       // half a turn
constexpr double kLeastGrowth = 1.002;
constexpr int kWidthBisections = 10;
// Of the engagement: where the gap beside the tool is thinner than rounding of the program or runout
// of the spindle, what is met is more than what is planned.
constexpr double kShare = 0.8;

constexpr double kWide = 0.3;  // radii: the gap is thick there
constexpr double kWideShare = 0.995;
constexpr double kSteps[] = {1.6, 1.2, 1.1, 1.03, 1.01, 1.0, 0.99, 0.97, 0.9, 0.8, 0.6, 0.4};

// mm: the radius of the first turn. Stock of up to `missed`, that discs and chords leave beside a
// turn already made, must be small beside it at the angle `most`.
double first_turn(double tool_radius, double most, double tolerance)
{
    const double missed = kMissedBeside * tool_radius + tolerance;
    return std::max(kFirstTurn * tool_radius, 4.0 * missed / (1.0 - std::cos(most)));
}

// Half a turn to the left from `from` to `to` mm on alternating sides of the centre.
Edge half_turn(Vec2d centre, double from, double to, double side)
{
    const Vec2d start{centre.x + side * from, centre.y};
    const Vec2d end{centre.x - side * to, centre.y};
    return arc_edge(start, end, (start + end) * 0.5, 1);
}

// Whether the tool meets no more along the edge than what stays beside a path.
bool is_clear(const Edge& edge, const SweptArea& swept)
{
    constexpr int kLooks = 32;
    constexpr double kCusp = 0.005;  // radii
    for (int i = 0; i <= kLooks; ++i) {
        const double share = static_cast<double>(i) / kLooks;
        if (swept.engagement(point_on(edge, share), tangent_on(edge, share),
                             -kCusp * swept.radius()) > 0.0) {
            return false;
        }
    }
    return true;
}

}  // namespace

EntrySpiral entry_spiral(SweptArea& swept,
                         Vec2d centre,
                         double radius,
                         const EntrySpiralLimits& limits)
{
    swept.add_disc(centre, swept.radius());
    EntrySpiral spiral;
    double side = -1.0;
    double at = 0.0;
    const auto add = [&](double to) {
        spiral.path.push_back(half_turn(centre, at, to, side));
        swept.add(spiral.path.back(), limits.tolerance);
        side = -side;
        at = to;
    };
    const double most = kShare * limits.max_engagement;
    const double first = std::min(first_turn(swept.radius(), most, limits.tolerance), radius);
    for (std::size_t i = 0; i < kFirstTurnEdges; ++i) {
        add(first);
    }
    const auto bound = [&](double to) {
        return swept.engagement_bound(half_turn(centre, at, to, side), most, limits.tolerance);
    };
    // The farthest that half a turn may end from the centre.
    const auto widest = [&](double limit) {
        double over = std::min(radius, kMostGrowth * at);
        if (bound(over) <= limit) {
            return over;
        }
        double good = at;
        for (int i = 0; i < kWidthBisections; ++i) {
            const double middle = 0.5 * (good + over);
            (bound(middle) <= limit ? good : over) = middle;
        }
        return good;
    };
    // Farther out half turns grow by nearly the same step: one that is kept is found beside it.
    double step = 0.0;
    const auto widest_beside = [&](double limit) {
        const auto keeps = [&](double to) {
            return swept.keeps(half_turn(centre, at, to, side), limit, limits.tolerance);
        };
        for (const double share : kSteps) {
            const double to = std::min(radius, at + share * step);
            if (to > at && keeps(to)) {
                return to;
            }
        }
        return at;
    };
    double whole = at;  // mm: radius of the largest whole turn
    while (at < radius) {
        if (at > kWide * swept.radius() && step > 0.0) {
            const double limit = kWideShare * limits.max_engagement;
            const double to = widest_beside(limit);
            if (to > at) {
                spiral.engagement_bound = std::max(spiral.engagement_bound, limit);
                step = to - at;
                whole = at;
                add(to);
                continue;
            }
        }
        double to = widest(most);
        if (to < kLeastGrowth * at) {
            to = widest(limits.max_engagement);
        }
        if (to < kLeastGrowth * at) {
            break;
        }
        spiral.engagement_bound = std::max(spiral.engagement_bound, bound(to));
        whole = at;
        step = to - at;
        add(to);
    }
    // Half a turn at the last radius, and one more where the spiral grew so fast that the first half
    // of its last turn is inside of that.
    for (int i = 0; i < 2 && whole < at && bound(at) <= limits.max_engagement; ++i) {
        spiral.engagement_bound = std::max(spiral.engagement_bound, bound(at));
        add(at);
        whole = i > 0 || is_clear(half_turn(centre, at, at, side), swept) ? at : whole;
    }
    swept.add_disc(centre, swept.radius() + std::max(whole - limits.tolerance, 0.0));
    spiral.radius = whole;
    return spiral;
}

}  // namespace cusp::adaptive_clearing
