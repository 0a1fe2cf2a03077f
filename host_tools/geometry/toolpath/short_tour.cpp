// Nearest neighbour, then exchanges of stretches of the tour: 2-opt turns one around, Or-opt moves up to
// three stops elsewhere. Only stretches that would join near stops are tried. At last two short stretches change
// places, here and there, and what does not become shorter by further exchanges is taken back.
#include "host_tools/geometry/toolpath/short_tour.hpp"

#include <algorithm>
#include <random>

#include "host_tools/geometry/toolpath/near_places.hpp"

namespace cusp::toolpath {

namespace {

constexpr std::size_t kNeighbours = 8;
constexpr std::size_t kMostMoved = 3;
// Stops that one exchange may turn or move, at first and when shaken: so the work stays near n log n.
constexpr std::size_t kMostChanged = 25000;
constexpr std::size_t kMostShaken = 3000;
constexpr double kGain = 1e-9;  // mm: less is rounding

double gap(const TourStop& a, const TourStop& b)
{
    return std::min({norm(a.begin - b.begin), norm(a.begin - b.end), norm(a.end - b.begin),
                     norm(a.end - b.end)});
}

// A ring of the stops and one more, the home: the tool comes back to it for nothing, or from the place where the tour
// is to end, and leaves it from the start. So a stretch may be turned around by turning all the others.
class Tour {
public:
    Tour(const std::vector<TourStop>& stops, Vec2d start, std::optional<Vec2d> end)
        : stops_{stops}, home_{stops.size()}, open_{!end}
    {
        stops_.push_back({end.value_or(start), start});
        is_awake_.resize(stops_.size());
        visit_nearest();
        find_neighbours();
    }

    // An open tour of places in an order that begins as `order` and in which each place stays before the one that it
    // lies in.
    Tour(const std::vector<TourStop>& stops,
         Vec2d start,
         const std::vector<std::size_t>& order,
         const std::vector<std::optional<std::size_t>>& outer)
        : stops_{stops}, home_{stops.size()}, open_{true}, outer_{outer}
    {
        stops_.push_back({start, start});
        is_awake_.resize(stops_.size());
        outer_.emplace_back();
        inner_.resize(stops_.size());
        for (std::size_t k = 0; k < stops.size(); ++k) {
            if (outer[k]) {
                inner_[*outer[k]].push_back(k);
            }
        }
        ring_.push_back({home_, false});
        for (const std::size_t stop : order) {
            ring_.push_back({stop, false});
        }
        number();
        find_neighbours();
    }

    void shorten()
    {
        for (std::size_t stop = 0; stop < stops_.size(); ++stop) {
            wake(stop);
        }
        exchange();
        shake();
    }

    std::vector<TourStep> steps() const
    {
        std::vector<TourStep> out;
        const bool turned = ring_[place_[home_]].turned;
        for (std::size_t k = 1; k < ring_.size(); ++k) {
            TourStep step = at(turned ? place_[home_] + ring_.size() - k : place_[home_] + k);
            step.turned = step.turned != turned;
            out.push_back(step);
        }
        return out;
    }

private:
    // Steps turned or moved in one go; its own inverse.
    struct Mirror {
        std::size_t from;
        std::size_t count;
        bool turns;  // each step too
    };

    const TourStep& at(std::size_t place) const { return ring_[place % ring_.size()]; }
    Vec2d entry(const TourStep& step) const
    {
        return step.turned ? stops_[step.stop].end : stops_[step.stop].begin;
    }
    TourStep turned(TourStep step) const { return {step.stop, !step.turned}; }
    // mm from one to the next.
    double way(const TourStep& from, const TourStep& to) const
    {
        const bool ends = (to.stop == home_ && !to.turned) || (from.stop == home_ && from.turned);
        return open_ && ends ? 0.0 : norm(entry(to) - entry(turned(from)));
    }

    void visit_nearest()
    {
        std::vector<Vec2d> ends;
        for (std::size_t k = 0; k < home_; ++k) {
            ends.push_back(stops_[k].begin);
            ends.push_back(stops_[k].end);
        }
        NearPlaces left{ends};
        ring_.push_back({home_, false});
        while (ring_.size() < stops_.size()) {
            const std::size_t end = left.nearest(entry(turned(ring_.back())), 1).front();
            left.take(end);
            left.take(end ^ 1);
            ring_.push_back({end / 2, end % 2 == 1});
        }
        number();
    }

    void number()
    {
        place_.resize(ring_.size());
        for (std::size_t k = 0; k < ring_.size(); ++k) {
            place_[ring_[k].stop] = k;
        }
    }

    bool lies_in(std::size_t stop, std::size_t from, std::size_t count) const
    {
        return (place_[stop] + 2 * ring_.size() - from) % ring_.size() < count;
    }

    // True if a stretch may be turned around: no stop of it lies in another of it.
    bool may_turn(std::size_t from, std::size_t count) const
    {
        if (outer_.empty()) {
            return true;
        }
        if (lies_in(home_, from, count)) {  // turning all the others is the same
            from += count;
            count = ring_.size() - count;
        }
        for (std::size_t k = 0; k < count; ++k) {
            const auto outer = outer_[at(from + k).stop];
            if (outer && lies_in(*outer, from, count)) {
                return false;
            }
        }
        return true;
    }

    // True if a stretch and the `by` stops after it may change places. Across the home they do not.
    bool may_swap(std::size_t from, std::size_t count, std::size_t by) const
    {
        if (outer_.empty()) {
            return true;
        }
        if (lies_in(home_, from, count + by)) {
            return false;
        }
        const bool comes_first = !ring_[place_[home_]].turned;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t stop = at(from + k).stop;
            const auto is_passed = [&](std::size_t other) {
                return lies_in(other, from + count, by);
            };
            if (comes_first ? outer_[stop] && is_passed(*outer_[stop])
                            : std::any_of(inner_[stop].begin(), inner_[stop].end(), is_passed)) {
                return false;
            }
        }
        return true;
    }

    // Likewise past `by` stops, or the other way round past all others: one of these does not cross the home.
    bool may_move(std::size_t from, std::size_t count, std::size_t by) const
    {
        const std::size_t rest = ring_.size() - count - by;
        return may_swap(from, count, by) || may_swap(from + ring_.size() - rest, rest, count);
    }

    void find_neighbours()
    {
        std::vector<Vec2d> ends;
        for (const TourStop& stop : stops_) {
            ends.push_back(stop.begin);
            ends.push_back(stop.end);
        }
        const NearPlaces all{ends};
        near_.resize(stops_.size());
        for (std::size_t k = 0; k < stops_.size(); ++k) {
            std::vector<std::pair<double, std::size_t>> found;
            for (const Vec2d end : {stops_[k].begin, stops_[k].end}) {
                for (const std::size_t other : all.nearest(end, 2 * kNeighbours + 2)) {
                    found.emplace_back(gap(stops_[k], stops_[other / 2]), other / 2);
                }
            }
            std::sort(found.begin(), found.end());
            found.erase(std::unique(found.begin(), found.end()), found.end());
            for (const auto& [distance, other] : found) {
                if (other != k && near_[k].size() < kNeighbours) {
                    near_[k].push_back(other);
                }
            }
        }
    }

    void wake(std::size_t stop)
    {
        if (!is_awake_[stop]) {
            is_awake_[stop] = true;
            awake_.push_back(stop);
        }
    }

    // Until no exchange near a stop that is awake saves anything.
    void exchange()
    {
        for (std::size_t k = 0; k < awake_.size(); ++k) {
            const std::size_t stop = awake_[k];
            is_awake_[stop] = false;
            while (exchange_at(stop)) {
            }
        }
        awake_.clear();
    }

    bool exchange_at(std::size_t stop)
    {
        const std::size_t here = place_[stop] + ring_.size();
        const double most = std::max(way(at(here - 1), at(here)), way(at(here), at(here + 1)));
        return std::any_of(near_[stop].begin(), near_[stop].end(), [&](std::size_t other) {
            return gap(stops_[stop], stops_[other]) < most &&
                   (turn_between(place_[stop], place_[other]) ||
                    move_beside(place_[stop], place_[other]));
        });
    }

    void mirror(const Mirror& one)
    {
        for (std::size_t k = 0; k < one.count / 2; ++k) {
            std::swap(ring_[(one.from + k) % ring_.size()],
                      ring_[(one.from + one.count - 1 - k) % ring_.size()]);
        }
        for (std::size_t k = 0; k < one.count; ++k) {
            const std::size_t place = (one.from + k) % ring_.size();
            ring_[place].turned = ring_[place].turned != one.turns;
            place_[ring_[place].stop] = place;
        }
    }
    void change(const Mirror& one)
    {
        mirror(one);
        changes_.push_back(one);
        for (const std::size_t place : {one.from + ring_.size() - 1, one.from,
                                        one.from + one.count - 1, one.from + one.count}) {
            wake(at(place).stop);
        }
    }
    // Two stretches that follow each other.
    void swap_stretches(std::size_t from, std::size_t first, std::size_t second)
    {
        change({from, first, false});
        change({from + first, second, false});
        change({from, first + second, false});
    }

    // Turns the stretch between the two around, so that one of them comes beside the other.
    bool turn_between(std::size_t a, std::size_t b)
    {
        const std::size_t size = ring_.size();
        const std::size_t count = (b + size - a) % size;
        return turn_if_shorter(a + 1, count) || turn_if_shorter(a, count);
    }

    bool turn_if_shorter(std::size_t from, std::size_t count)
    {
        const std::size_t size = ring_.size();
        const TourStep& before = at(from + size - 1);
        const TourStep& first = at(from);
        const TourStep& last = at(from + count - 1);
        const TourStep& after = at(from + count);
        const double saves = way(before, first) + way(last, after) - way(before, turned(last)) -
                             way(turned(first), after);
        const std::size_t rest = size - count;
        if (!(saves > kGain) || std::min(count, rest) > most_changed_ || !may_turn(from, count)) {
            return false;
        }
        saved_ += saves;
        change(count <= rest ? Mirror{from % size, count, true}
                             : Mirror{(from + count) % size, rest, true});
        return true;
    }

    // Moves one to three stops that begin or end at `a` before or after the stop at `b`, as they are or turned.
    bool move_beside(std::size_t a, std::size_t b)
    {
        const std::size_t size = ring_.size();
        for (std::size_t count = 1; count <= kMostMoved && count + 2 <= size; ++count) {
            for (const std::size_t from : {a, a + size - count + 1}) {
                const std::size_t ahead =
                    (b + 2 * size - from) % size;  // of b, from the stretch's begin
                if (ahead < count) {
                    continue;
                }
                if (move_if_shorter(from % size, count, ahead - count) ||
                    move_if_shorter(from % size, count, ahead - count + 1)) {
                    return true;
                }
            }
        }
        return false;
    }

    // by  stops that it passes
    bool move_if_shorter(std::size_t from, std::size_t count, std::size_t by)
    {
        const std::size_t size = ring_.size();
        if (by == 0 || by + count >= size) {
            return false;
        }
        const TourStep& first = at(from);
        const TourStep& last = at(from + count - 1);
        const TourStep& before = at(from + size - 1);
        const TourStep& after = at(from + count);
        const TourStep& left = at(from + count + by - 1);
        const TourStep& right = at(from + count + by);
        const double freed =
            way(before, first) + way(last, after) + way(left, right) - way(before, after);
        const double straight = way(left, first) + way(last, right);
        const double around = way(left, turned(last)) + way(turned(first), right);
        const double saves = freed - std::min(straight, around);
        const std::size_t rest = size - count - by;
        if (!(saves > kGain) || std::min(by, rest) > most_changed_ || !may_move(from, count, by) ||
            (around < straight && !may_turn(from, count))) {
            return false;
        }
        saved_ += saves;
        if (around < straight) {
            change({from, count, true});
        }
        if (by <= rest) {
            swap_stretches(from, count, by);
        } else {
            swap_stretches((from + size - rest) % size, rest, count);
        }
        return true;
    }

    // Shortens further by exchanges that lengthen it first.
    void shake()
    {
        constexpr std::size_t kShakes = 1;    // of each stop
        constexpr std::size_t kLongest = 50;  // stops of a stretch
        constexpr std::size_t kLeast = 8;     // stops in all: fewer have no better tour left
        const std::size_t size = ring_.size();
        if (size < kLeast) {
            return;
        }
        most_changed_ = kMostShaken;
        std::minstd_rand random;
        const std::size_t most = std::min(kLongest, (size - 2) / 2);
        for (std::size_t k = 0; k < kShakes * size; ++k) {
            const std::size_t from = random() % size;
            const std::size_t first = 1 + random() % most;
            const std::size_t second = 1 + random() % most;
            const TourStep& before = at(from + size - 1);
            const TourStep& middle = at(from + first);
            const TourStep& after = at(from + first + second);
            const TourStep& end = at(from + first - 1);
            const TourStep& last = at(from + first + second - 1);
            if (!may_swap(from, first, second)) {
                continue;
            }
            changes_.clear();
            saved_ = way(before, at(from)) + way(end, middle) + way(last, after) -
                     way(before, middle) - way(last, at(from)) - way(end, after);
            swap_stretches(from, first, second);
            exchange();
            if (saved_ < kGain) {
                std::for_each(changes_.rbegin(), changes_.rend(),
                              [&](const Mirror& one) { mirror(one); });
            }
        }
    }

    std::vector<TourStop> stops_;
    std::size_t home_;
    bool open_;
    // The stop that each one lies in, and those that lie in it; empty: none does.
    std::vector<std::optional<std::size_t>> outer_;
    std::vector<std::vector<std::size_t>> inner_;
    std::vector<TourStep> ring_;
    std::vector<std::size_t> place_;  // in the ring, of each stop
    std::vector<std::vector<std::size_t>> near_;
    std::vector<std::size_t> awake_;
    std::vector<bool> is_awake_;
    std::vector<Mirror> changes_;  // since the last shake
    double saved_{};               // mm, by them
    std::size_t most_changed_{kMostChanged};
};

}  // namespace

std::vector<TourStep> short_tour(const std::vector<TourStop>& stops,
                                 Vec2d start,
                                 std::optional<Vec2d> end)
{
    Tour tour{stops, start, end};
    tour.shorten();
    return tour.steps();
}

std::vector<std::size_t> short_tour(const std::vector<Vec2d>& places,
                                    Vec2d start,
                                    std::optional<Vec2d> end)
{
    std::vector<TourStop> stops;
    for (const Vec2d place : places) {
        stops.push_back({place, place});
    }
    std::vector<std::size_t> order;
    for (const TourStep& step : short_tour(stops, start, end)) {
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
    // Each outermost one with all that is inside it, level by level: the tour of a level ends at what it is in.
    std::vector<std::size_t> out;
    Vec2d here = start;
    const auto visit = [&](const std::vector<std::size_t>& members, std::optional<Vec2d> end) {
        std::vector<Vec2d> starts;
        for (const std::size_t member : members) {
            starts.push_back(places[member]);
        }
        std::vector<std::size_t> order;
        for (const std::size_t k : short_tour(starts, here, end)) {
            order.push_back(members[k]);
        }
        return order;
    };
    struct Step {
        std::size_t place;
        bool inside_done;
    };
    std::vector<Step> open;  // the next one last
    const auto push = [&](std::vector<std::size_t> order) {
        std::reverse(order.begin(), order.end());
        for (const std::size_t place : order) {
            open.push_back({place, false});
        }
    };
    push(visit(outermost, std::nullopt));
    while (!open.empty()) {
        const Step step = open.back();
        open.back().inside_done = true;
        if (!step.inside_done && !inside[step.place].empty()) {
            push(visit(inside[step.place], places[step.place]));
            continue;
        }
        out.push_back(step.place);
        here = places[step.place];
        open.pop_back();
    }
    std::vector<TourStop> stops;
    for (const Vec2d place : places) {
        stops.push_back({place, place});
    }
    Tour tour{stops, start, out, outer};
    tour.shorten();
    out.clear();
    for (const TourStep& step : tour.steps()) {
        out.push_back(step.stop);
    }
    return out;
}

}  // namespace cusp::toolpath
