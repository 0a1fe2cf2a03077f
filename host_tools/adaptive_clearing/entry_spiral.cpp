// The ends of the half turns lie on a line through the centre, on alternating sides.
#include "host_tools/adaptive_clearing/entry_spiral.hpp"

#include <algorithm>

namespace cusp::adaptive_clearing {

using offset::arc_edge;
using offset::Edge;

namespace {

constexpr double kFirstTurn = 0.04;  // radii of the tool
constexpr double kMostGrowth = 1.6;  // half a turn
constexpr double kLeastGrowth = 1.002;
constexpr int kWidthBisections = 10;
// Of the engagement: where the gap beside the tool is thinner than rounding of the program or runout
// of the spindle, what is met is more than what is planned.
constexpr double kShare = 0.8;

// Half a turn to the left from `from` to `to` mm on alternating sides of the centre.
Edge half_turn(Vec2d centre, double from, double to, double side)
{
    const Vec2d start{centre.x + side * from, centre.y};
    const Vec2d end{centre.x - side * to, centre.y};
    return arc_edge(start, end, (start + end) * 0.5, 1);
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
    const double first = std::min(kFirstTurn * swept.radius(), radius);
    for (std::size_t i = 0; i < kFirstTurnEdges; ++i) {
        add(first);
    }
    const double most = kShare * limits.max_engagement;
    const auto bound = [&](double to) {
        return swept.engagement_bound(half_turn(centre, at, to, side), most, limits.tolerance);
    };
    // Half a turn at the same radius ends the spiral.
    for (double last = 0.0; last < at;) {
        last = at;
        double to = std::min(radius, kMostGrowth * at);
        if (bound(to) > most) {
            double good = at;
            for (int i = 0; i < kWidthBisections; ++i) {
                const double middle = 0.5 * (good + to);
                (bound(middle) <= most ? good : to) = middle;
            }
            to = good < kLeastGrowth * at ? at : good;
        }
        spiral.engagement_bound = std::max(spiral.engagement_bound, bound(to));
        add(to);
    }
    // The last two half turns are a circle.
    swept.add_disc(centre, swept.radius() + std::max(at - limits.tolerance, 0.0));
    spiral.radius = at;
    return spiral;
}

}  // namespace cusp::adaptive_clearing
