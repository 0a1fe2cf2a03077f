// Two turns are joined by the line that touches both. All of a turn is measured before it is made:
// it sweeps the disc about its centre, so one disc is enough.
#include "host_tools/cam/adaptive_clearing/trochoids.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/clearing/clear_path.hpp"

namespace cusp::adaptive_clearing {

using clearing::is_path_clear;
using offset::arc_edge;
using offset::Edge;
using offset::line_edge;
using offset::unit;

namespace {

constexpr double kStripOfTurn = 0.004;  // radii: left along the walls
constexpr double kStripOfRoom = 0.1;    // at most
constexpr double kChords = 0.005;       // of the room: tolerance of chords
constexpr double kFirstStep = 0.2;      // of the room
constexpr double kLeastStep = 0.02;     // of the room
constexpr double kLongestStep = 0.5;    // radii
constexpr double kLonger = 1.15;        // from step to step
constexpr double kShorter = 0.85;
constexpr double kWider = 0.5;            // of the step: from turn to turn
constexpr double kMissedByTurn = 0.0004;  // radii: the width that the disc of a turn may miss
constexpr double kSliverOfTurn = 0.01;    // radii: thinner stock does not count
constexpr double kBarelyInTurn = 0.03;    // radians: less is no stock
constexpr int kLooks = 24;                // around a turn

// A turn of the tool's centre.
struct Turn {
    Vec2d centre;
    double radius;
};

// As large as the walls allow, with a strip left along them.
Turn turn_about(Vec2d centre, double most_room, const TrochoidSpace& space)
{
    const double room =
        std::min(most_room, space.walls.nearest(centre, kUnbounded) - space.wall_clearance);
    return {centre, room - std::min(kStripOfTurn * space.swept.radius(), kStripOfRoom * room)};
}

Vec2d on(const Turn& turn, double angle)
{
    return turn.centre + Vec2d{elementary::cos(angle), elementary::sin(angle)} * turn.radius;
}

// To the left, in arcs of less than half a turn.
void add_arcs(const Turn& turn, double from, double by, std::vector<Edge>& path)
{
    const int n = static_cast<int>(std::ceil(by / (0.7 * kPi)));
    for (int i = 0; i < n; ++i) {
        path.push_back(arc_edge(on(turn, from + by * i / n), on(turn, from + by * (i + 1) / n),
                                turn.centre, 1));
    }
}

double bound_of(const std::vector<Edge>& path, const TrochoidSpace& space, double tolerance)
{
    double most = 0.0;
    for (const Edge& edge : path) {
        most = std::max(most, space.swept.engagement_bound(edge, space.max_engagement, tolerance));
        if (most > space.max_engagement) {
            break;
        }
    }
    return most;
}

bool has_stock(const Turn& turn, const TrochoidSpace& space)
{
    for (int i = 0; i < kLooks; ++i) {
        const double angle = 2 * kPi * i / kLooks;
        if (space.swept.engagement(on(turn, angle),
                                   {-elementary::sin(angle), elementary::cos(angle)},
                                   -kSliverOfTurn * space.swept.radius()) > kBarelyInTurn) {
            return true;
        }
    }
    return false;
}

// Angle on the turn, about its centre, at which the tool comes down in no stock; none if stock is
// all around.
std::optional<double> begin_of(const Turn& turn, const TrochoidSpace& space)
{
    for (int i = 0; i < kLooks; ++i) {
        const double angle = 2 * kPi * i / kLooks;
        if (space.swept.engagement(on(turn, angle), {1.0, 0.0},
                                   -kSliverOfTurn * space.swept.radius(), kPi) <= 0.0) {
            return angle;
        }
    }
    return std::nullopt;
}

// Angle about their centres at which the line that touches both turns on their right leaves them;
// none if one is inside the other.
std::optional<double> tangent_angle(const Turn& a, const Turn& b)
{
    const Vec2d way = b.centre - a.centre;
    const double sine = (a.radius - b.radius) / std::max(norm(way), 1e-12);
    if (std::abs(sine) > 0.9) {
        return std::nullopt;
    }
    return elementary::atan2(way.y, way.x) + elementary::asin(sine) - 0.5 * kPi;
}

// Places along a way by their distance from its beginning.
class Ruler {
public:
    explicit Ruler(const NeckWay& way) : way_{way}
    {
        for (std::size_t i = 1; i < way.size(); ++i) {
            at_.push_back(at_.back() + norm(way[i].centre - way[i - 1].centre));
        }
    }

    double at(std::size_t place) const { return at_[place]; }

    Vec2d point(double at) const
    {
        const auto next = std::upper_bound(at_.begin(), at_.end(), at);
        if (next == at_.begin() || next == at_.end()) {
            return (next == at_.begin() ? way_.front() : way_.back()).centre;
        }
        const auto i = static_cast<std::size_t>(next - at_.begin());
        const double share = (at - at_[i - 1]) / std::max(at_[i] - at_[i - 1], 1e-12);
        return way_[i - 1].centre + (way_[i].centre - way_[i - 1].centre) * share;
    }

private:
    const NeckWay& way_;
    std::vector<double> at_{0.0};
};

// By how much a turn may be less than whole: the discs at its ends miss kMissedByTurn between them.
double most_less(const Turn& turn, double radius)
{
    return std::sqrt(8.0 * kMissedByTurn * radius / (turn.radius * (1.0 + turn.radius / radius)));
}

class TrochoidWriter {
public:
    // from  radians: the angle about its centre where the first turn begins
    TrochoidWriter(const Turn& first, double from, const TrochoidSpace& space)
        : space_{space}, last_{first}, at_{from}
    {
    }

    // The turn before the first line. Nothing is done where it does not keep the
    // engagement.
    bool begin(bool in_stock)
    {
        std::vector<Edge> turn;
        add_arcs(last_, at_, 2 * kPi, turn);
        const double tolerance = std::min(space_.tolerance, kChords * last_.radius);
        const double most = bound_of(turn, space_, tolerance);
        if (most > space_.max_engagement) {
            return false;
        }
        count(most, tolerance);
        if (in_stock) {
            sweep(last_, tolerance);
            makes_ = true;
        }
        return true;
    }

    // The line to the next turn, and that turn. Nothing is done where they do not keep the
    // engagement.
    bool add(const Turn& next)
    {
        const std::optional<double> leaves = tangent_angle(last_, next);
        if (next.radius <= 0.0 || !leaves) {
            return false;
        }
        const Edge line = line_edge(on(last_, *leaves), on(next, *leaves));
        if (!is_path_clear(space_.walls, line, space_.wall_clearance)) {
            return false;
        }
        std::vector<Edge> more{line};
        add_arcs(next, *leaves, 2 * kPi, more);
        const double tolerance = std::min(space_.tolerance, kChords * next.radius);
        const double most = bound_of(more, space_, tolerance);
        if (most > space_.max_engagement) {
            return false;
        }
        leave(*leaves);
        pass_.path.push_back(line);
        count(most, tolerance);
        sweep(next, tolerance);
        last_ = next;
        at_ = *leaves;
        makes_ = true;
        return true;
    }

    TrochoidPass pass()
    {
        if (!makes_) {
            return {};
        }
        leave(at_);
        return std::move(pass_);
    }

private:
    void count(double bound, double tolerance)
    {
        pass_.engagement_bound = std::max(pass_.engagement_bound, bound);
        pass_.tolerance = std::min(pass_.tolerance, tolerance);
    }

    void sweep(const Turn& turn, double tolerance)
    {
        const double radius = space_.swept.radius();
        space_.swept.add_disc(turn.centre,
                              radius + turn.radius - tolerance - kMissedByTurn * radius);
    }

    // A turn from where the line before met it to where the next one leaves.
    void leave(double angle)
    {
        const double more = std::remainder(angle - at_, 2 * kPi);
        const bool enough = more >= -most_less(last_, space_.swept.radius());
        add_arcs(last_, at_, 2 * kPi * (enough ? 1 : 2) + more, pass_.path);
    }

    const TrochoidSpace& space_;
    Turn last_;
    double at_;     // the angle about its centre where the tool came to it
    bool makes_{};  // anything
    TrochoidPass pass_;
};

}  // namespace

std::optional<NeckStock> stock_along(const NeckWay& way,
                                     std::size_t from,
                                     const TrochoidSpace& space)
{
    const auto remains = [&](const NeckPlace& place) {
        return has_stock(turn_about(place.centre, kUnbounded, space), space);
    };
    const auto begin = way.begin() + static_cast<std::ptrdiff_t>(std::min(from, way.size()));
    const auto first = std::find_if(begin, way.end(), remains);
    if (first == way.end()) {
        return std::nullopt;
    }
    const auto end = std::find_if_not(first, way.end(), remains);
    return NeckStock{static_cast<std::size_t>(first - way.begin()),
                     static_cast<std::size_t>(end - way.begin()) - 1};
}

Vec2d trochoid_start(Vec2d centre, double most_room, const TrochoidSpace& space)
{
    const Turn turn = turn_about(centre, most_room, space);
    return on(turn, begin_of(turn, space).value_or(0.0));
}

TrochoidPass trochoidal_pass(const NeckWay& way,
                             std::size_t from,
                             std::size_t to,
                             double most_room,
                             const TrochoidSpace& space)
{
    const Ruler ruler{way};
    const double end = ruler.at(to);
    const double sign = to > from ? 1.0 : -1.0;
    double at = ruler.at(from);
    Turn turn = turn_about(way[from].centre, most_room, space);
    const std::optional<double> begin = begin_of(turn, space);
    if (turn.radius <= 0.0 || !begin) {
        return {};
    }
    TrochoidWriter writer{turn, *begin, space};
    if (!writer.begin(has_stock(turn, space))) {
        return {};
    }
    double step = kFirstStep * turn.radius;
    while (sign * (end - at) > 0.0) {
        const double next_at = sign * (end - at) > step ? at + sign * step : end;
        const Turn next =
            turn_about(ruler.point(next_at), turn.radius + kWider * std::abs(next_at - at), space);
        if (writer.add(next)) {
            at = next_at;
            turn = next;
            step = std::min(step * kLonger, kLongestStep * space.swept.radius());
            continue;
        }
        step *= kShorter;
        if (step < kLeastStep * turn.radius) {
            break;
        }
    }
    return writer.pass();
}

}  // namespace cusp::adaptive_clearing
