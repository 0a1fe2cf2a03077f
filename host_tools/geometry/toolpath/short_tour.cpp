// Nearest neighbour, then exchanges of stretches of the tour: 2-opt turns one around, Or-opt moves up to
// three stops elsewhere. Only stretches that would join near stops are tried.
#include "host_tools/geometry/toolpath/short_tour.hpp"

#include <algorithm>

namespace cusp::toolpath {

namespace {

constexpr std::size_t kNeighbours = 8;
constexpr std::size_t kMostMoved = 3;
constexpr int kMostRounds = 50;
constexpr double kGain = 1e-9;  // mm: less is rounding

double gap(const TourStop& a, const TourStop& b)
{
    return std::min({norm(a.begin - b.begin), norm(a.begin - b.end), norm(a.end - b.begin),
                     norm(a.end - b.end)});
}

class Tour {
public:
    Tour(const std::vector<TourStop>& stops, Vec2d start) : stops_{stops}, start_{start}
    {
        visit_nearest();
        find_neighbours();
    }

    void shorten()
    {
        bool shorter = true;
        for (int round = 0; shorter && round < kMostRounds; ++round) {
            shorter = false;
            for (std::size_t stop = 0; stop < stops_.size(); ++stop) {
                for (const std::size_t other : near_[stop]) {
                    shorter = turn_between(place_[stop], place_[other]) || shorter;
                    shorter = move_beside(place_[stop], place_[other]) || shorter;
                }
            }
        }
    }

    const std::vector<TourStep>& steps() const { return steps_; }

private:
    using Iterator = std::vector<TourStep>::iterator;

    Vec2d entry(const TourStep& step) const
    {
        return step.turned ? stops_[step.stop].end : stops_[step.stop].begin;
    }
    Vec2d exit(const TourStep& step) const
    {
        return step.turned ? stops_[step.stop].begin : stops_[step.stop].end;
    }
    // Place of the tool before a place of the tour.
    Vec2d before(std::size_t place) const { return place == 0 ? start_ : exit(steps_[place - 1]); }
    // mm from there to the entry at a place; nothing comes after the last one.
    double way_to(Vec2d from, std::size_t place) const
    {
        return place < steps_.size() ? norm(entry(steps_[place]) - from) : 0.0;
    }
    Iterator at(std::size_t place) { return steps_.begin() + static_cast<std::ptrdiff_t>(place); }

    void visit_nearest()
    {
        std::vector<std::size_t> left(stops_.size());
        for (std::size_t k = 0; k < left.size(); ++k) {
            left[k] = k;
        }
        Vec2d here = start_;
        while (!left.empty()) {
            std::size_t best = 0;
            TourStep step{left[0], false};
            double least = kUnbounded;
            for (std::size_t k = 0; k < left.size(); ++k) {
                for (const bool turned : {false, true}) {
                    const double d = norm(entry({left[k], turned}) - here);
                    if (d < least) {
                        least = d;
                        best = k;
                        step = {left[k], turned};
                    }
                }
            }
            steps_.push_back(step);
            here = exit(step);
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
        }
        place_.resize(steps_.size());
        number(0, steps_.size());
    }

    void find_neighbours()
    {
        near_.resize(stops_.size());
        std::vector<std::pair<double, std::size_t>> found;
        for (std::size_t k = 0; k < stops_.size(); ++k) {
            found.clear();
            for (std::size_t other = 0; other < stops_.size(); ++other) {
                if (other == k) {
                    continue;
                }
                const std::pair<double, std::size_t> one{gap(stops_[k], stops_[other]), other};
                if (found.size() == kNeighbours && !(one < found.back())) {
                    continue;
                }
                if (found.size() == kNeighbours) {
                    found.pop_back();
                }
                found.insert(std::upper_bound(found.begin(), found.end(), one), one);
            }
            for (const auto& [distance, other] : found) {
                near_[k].push_back(other);
            }
        }
    }

    void number(std::size_t from, std::size_t to)
    {
        for (std::size_t k = from; k < to; ++k) {
            place_[steps_[k].stop] = k;
        }
    }

    void turn(std::size_t from, std::size_t to)
    {
        std::reverse(at(from), at(to));
        std::for_each(at(from), at(to), [](TourStep& step) { step.turned = !step.turned; });
    }

    // Turns the stretch between the two around, so that one of them comes beside the other.
    bool turn_between(std::size_t a, std::size_t b)
    {
        const auto [low, high] = std::minmax(a, b);
        return turn_if_shorter(low + 1, high + 1) || turn_if_shorter(low, high);
    }

    bool turn_if_shorter(std::size_t from, std::size_t to)
    {
        const Vec2d here = before(from);
        const Vec2d first = entry(steps_[from]);
        const Vec2d last = exit(steps_[to - 1]);
        const double now = norm(first - here) + way_to(last, to);
        const double then = norm(last - here) + way_to(first, to);
        if (!(then < now - kGain)) {
            return false;
        }
        turn(from, to);
        number(from, to);
        return true;
    }

    // Moves one to three stops from `a` on before or after the stop at `b`, as they are or turned.
    bool move_beside(std::size_t a, std::size_t b)
    {
        for (std::size_t count = 1; count <= kMostMoved && a + count <= steps_.size(); ++count) {
            if (b >= a && b < a + count) {
                return false;
            }
            for (const std::size_t to : {b, b + 1}) {
                if ((to < a || to > a + count) && move_if_shorter(a, a + count, to)) {
                    return true;
                }
            }
        }
        return false;
    }

    // to  the place that the stretch is put before
    bool move_if_shorter(std::size_t from, std::size_t end, std::size_t to)
    {
        const Vec2d first = entry(steps_[from]);
        const Vec2d last = exit(steps_[end - 1]);
        const double freed =
            norm(first - before(from)) + way_to(last, end) - way_to(before(from), end);
        const Vec2d here = before(to);
        const double whole = way_to(here, to);
        const double straight = norm(first - here) + way_to(last, to) - whole;
        const double turned = norm(last - here) + way_to(first, to) - whole;
        if (!(std::min(straight, turned) < freed - kGain)) {
            return false;
        }
        if (turned < straight) {
            turn(from, end);
        }
        if (to < from) {
            std::rotate(at(to), at(from), at(end));
            number(to, end);
        } else {
            std::rotate(at(from), at(end), at(to));
            number(from, to);
        }
        return true;
    }

    const std::vector<TourStop>& stops_;
    Vec2d start_;
    std::vector<TourStep> steps_;
    std::vector<std::size_t> place_;  // in the tour, of each stop
    std::vector<std::vector<std::size_t>> near_;
};

}  // namespace

std::vector<TourStep> short_tour(const std::vector<TourStop>& stops, Vec2d start)
{
    constexpr std::size_t kMost = 20000;  // all pairs are looked at
    Tour tour{stops, start};
    if (stops.size() <= kMost) {
        tour.shorten();
    }
    return tour.steps();
}

std::vector<std::size_t> short_tour(const std::vector<Vec2d>& places, Vec2d start)
{
    std::vector<TourStop> stops;
    for (const Vec2d place : places) {
        stops.push_back({place, place});
    }
    std::vector<std::size_t> order;
    for (const TourStep& step : short_tour(stops, start)) {
        order.push_back(step.stop);
    }
    return order;
}

std::vector<std::size_t> inner_first_tour(const std::vector<Vec2d>& places,
                                          const std::vector<std::optional<std::size_t>>& outer,
                                          Vec2d start)
{
    std::vector<std::vector<std::size_t>> inside(places.size());
    std::vector<std::size_t> outermost;
    for (std::size_t k = 0; k < places.size(); ++k) {
        (outer[k] ? inside[*outer[k]] : outermost).push_back(k);
    }
    struct Level {
        std::vector<std::size_t> order;  // still to come, the next one last
        std::optional<std::size_t> around;
    };
    std::vector<std::size_t> out;
    Vec2d here = start;
    const auto level = [&](const std::vector<std::size_t>& members,
                           std::optional<std::size_t> around) {
        std::vector<Vec2d> starts;
        for (const std::size_t member : members) {
            starts.push_back(places[member]);
        }
        Level made{{}, around};
        for (const std::size_t k : short_tour(starts, here)) {
            made.order.push_back(members[k]);
        }
        std::reverse(made.order.begin(), made.order.end());
        return made;
    };
    std::vector<Level> levels{level(outermost, std::nullopt)};
    while (!levels.empty()) {
        if (levels.back().order.empty()) {
            if (const auto around = levels.back().around) {
                out.push_back(*around);
                here = places[*around];
            }
            levels.pop_back();
            continue;
        }
        const std::size_t next = levels.back().order.back();
        levels.back().order.pop_back();
        levels.push_back(level(inside[next], next));
    }
    return out;
}

}  // namespace cusp::toolpath
