// The ends of the half turns lie on a line through the centre, on alternating sides.
#include "host_tools/cam/adaptive_clearing/entry_spiral.hpp"

#include <algorithm>
#include <utility>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::adaptive_clearing {

using offset::arc_edge;
using offset::Edge;

namespace {

constexpr double kFirstTurn = 0.04;       // radii of the tool, at least
constexpr double kMissedBeside = 0.0004;  // radii, by SweptArea
constexpr double kMostGrowth = 1.6;       // half a turn
constexpr double kLeastGrowth = 1.002;
constexpr int kWidthBisections = 10;
// Share of the engagement that is planned: where the gap beside the tool is thinner than rounding
// of the program or runout of the spindle, what is met is more than what is planned.
constexpr double kShare = 0.8;

// Of the tolerance: a half turn that grew by no more is as wide as the last one.
constexpr double kSameTurn = 0.1;

constexpr double kThickGap = 0.3;  // radii from the centre: the gap is thick there
constexpr double kWideShare = 0.995;
constexpr double kSteps[] = {1.6, 1.2, 1.1, 1.03, 1.01, 1.0, 0.99, 0.97, 0.9, 0.8, 0.6, 0.4};

// mm: the radius of the first turn. Stock of up to `missed`, that discs and chords leave beside a
// turn already made, must be small beside it at the angle `most`.
double first_turn(double tool_radius, double most, double tolerance)
{
    const double missed = kMissedBeside * tool_radius + tolerance;
    return std::max(kFirstTurn * tool_radius, 4.0 * missed / (1.0 - elementary::cos(most)));
}

// Half a turn to the left from `from` to `to` mm on alternating sides of the centre.
Edge half_turn(Vec2d centre, double from, double to, double side)
{
    const Vec2d start{centre.x + side * from, centre.y};
    const Vec2d end{centre.x - side * to, centre.y};
    return arc_edge(start, end, (start + end) * 0.5, 1);
}

class SpiralPath {
public:
    // widest  mm: the radius that it may reach
    SpiralPath(SweptArea& swept, Vec2d centre, double widest, const EntrySpiralLimits& limits)
        : swept_{swept},
          centre_{centre},
          widest_{widest},
          limits_{limits},
          most_{kShare * limits.max_engagement}
    {
    }

    void turn_first()
    {
        const double first =
            std::min(first_turn(swept_.radius(), most_, limits_.tolerance), widest_);
        for (std::size_t i = 0; i < kFirstTurnEdges; ++i) {
            add(first);
        }
        whole_ = at_;
    }

    // Half turns as wide as the limit allows.
    void widen()
    {
        double step = 0.0;
        while (at_ < widest_) {
            const double limit = kWideShare * limits_.max_engagement;
            double to = at_ > kThickGap * swept_.radius() ? farthest_near(step, limit) : at_;
            double bound = limit;
            if (to <= at_) {
                to = farthest();
                if (to < kLeastGrowth * at_) {
                    return;
                }
                bound = bound_to(to);
            }
            found_.engagement_bound = std::max(found_.engagement_bound, bound);
            whole_ = at_;
            step = to - at_;
            add(to);
        }
    }

    // Half a turn at the last radius, and one more where the first half of the last turn is inside of that: beside
    // walls that the spiral reaches nothing cuts after it.
    EntrySpiral close()
    {
        for (int i = 0; i < 2 && whole_ < at_ && bound_to(at_) <= limits_.max_engagement; ++i) {
            found_.engagement_bound = std::max(found_.engagement_bound, bound_to(at_));
            add(at_);
            whole_ = i > 0 || at_ - whole_ <= kSameTurn * limits_.tolerance ? at_ : whole_;
        }
        swept_.add_disc(centre_, swept_.radius() + std::max(whole_ - limits_.tolerance, 0.0));
        found_.radius = whole_;
        return std::move(found_);
    }

private:
    void add(double to)
    {
        found_.path.push_back(half_turn(centre_, at_, to, side_));
        swept_.add(found_.path.back(), limits_.tolerance);
        side_ = -side_;
        at_ = to;
    }

    double bound_to(double to) const
    {
        return swept_.engagement_bound(half_turn(centre_, at_, to, side_), most_,
                                       limits_.tolerance);
    }

    // The farthest that half a turn may end from the centre.
    double farthest() const
    {
        const double to = farthest_within(most_);
        return to < kLeastGrowth * at_ ? farthest_within(limits_.max_engagement) : to;
    }

    double farthest_within(double limit) const
    {
        double over = std::min(widest_, kMostGrowth * at_);
        if (bound_to(over) <= limit) {
            return over;
        }
        double good = at_;
        for (int i = 0; i < kWidthBisections; ++i) {
            const double middle = 0.5 * (good + over);
            (bound_to(middle) <= limit ? good : over) = middle;
        }
        return good;
    }

    // Far out half turns grow by nearly the step of the one before: one that is kept is beside it.
    double farthest_near(double step, double limit) const
    {
        for (const double share : kSteps) {
            const double to = std::min(widest_, at_ + share * step);
            if (to > at_ &&
                swept_.keeps(half_turn(centre_, at_, to, side_), limit, limits_.tolerance)) {
                return to;
            }
        }
        return at_;
    }

    SweptArea& swept_;
    Vec2d centre_;
    double widest_;
    EntrySpiralLimits limits_;
    double most_;  // radians: where the gap beside the tool is thin
    EntrySpiral found_;
    double side_{-1.0};
    double at_{0.0};     // mm from the centre
    double whole_{0.0};  // mm: radius of the largest whole turn
};

}  // namespace

EntrySpiral entry_spiral(SweptArea& swept,
                         Vec2d centre,
                         double radius,
                         const EntrySpiralLimits& limits)
{
    swept.add_disc(centre, swept.radius());
    SpiralPath spiral{swept, centre, radius, limits};
    spiral.turn_first();
    spiral.widen();
    return spiral.close();
}

}  // namespace cusp::adaptive_clearing
