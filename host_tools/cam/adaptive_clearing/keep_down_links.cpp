// A link leaves the stock beside the end of its pass at the feed, continues where nothing is near, and
// comes up to the stock beside its start at the feed again. Ways around are found on a lattice.
#include "host_tools/cam/adaptive_clearing/keep_down_links.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>
#include <unordered_map>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/clearing/clear_path.hpp"

namespace cusp::adaptive_clearing {

using clearing::is_path_clear;
using offset::left_normal;
using offset::line_edge;
using offset::RegionOffset;
using offset::unit;

namespace {

// In radii.
constexpr double kMargin = 0.03;
constexpr double kRoom = 0.06;  // the margin and half of kLook
constexpr double kLook = 0.06;  // between places that are looked at
constexpr int kFew = 8;         // of them, one is looked at first
constexpr double kLattice = 0.5;
constexpr double kCusp = 0.005;  // less than that stays beside a path that was cut
constexpr double kLongest = 60.0;
constexpr double kSamePlace = 1e-6;
constexpr double kBeside[] = {0.1, 0.2, 0.4, 0.8};
constexpr int kSides = 16;
constexpr std::size_t kMostNodes = 4000;  // that a way around may be looked for at
constexpr double kMet = 0.3;              // radians, most of a link
constexpr double kNone = 1e-9;            // radians
constexpr std::int64_t kHalf = std::int64_t{1} << 31;

}  // namespace

KeepDownLinks::KeepDownLinks(const SweptArea& swept,
                             const RegionOffset& walls,
                             double wall_clearance)
    : swept_{swept},
      walls_{walls},
      wall_clearance_{wall_clearance},
      radius_{swept.radius()},
      pitch_{kLattice * radius_}
{
}

// All around the tool at the place nothing is near.
bool KeepDownLinks::is_room(Vec2d place) const
{
    constexpr int kFirst = 8;
    for (int i = 0; i < kFirst; ++i) {
        const double angle = 2 * kPi * i / kFirst;
        if (!swept_.contains(place +
                             Vec2d{elementary::cos(angle), elementary::sin(angle)} * radius_)) {
            return false;
        }
    }
    return swept_.engagement(place, {1.0, 0.0}, kRoom * radius_, kPi) < kNone &&
           !walls_.any_nearer(place, wall_clearance_ + kMargin * radius_);
}

// Nothing is near the tool on the straight way between two places with room.
bool KeepDownLinks::is_free(Vec2d from, Vec2d to) const
{
    const double size = norm(to - from);
    const Vec2d heading = unit(to - from);
    const int n = static_cast<int>(std::ceil(size / (kLook * radius_)));
    const auto place = [&](int i) {
        return from + (to - from) * ((i + 0.5) / n);
    };
    // A few points find at once most of what is in the way.
    const Vec2d ahead = heading * radius_;
    const Vec2d aside = left_normal(ahead);
    for (int i = 0; i < n; i += kFew) {
        for (const Vec2d& point : {ahead, aside, aside * -1.0}) {
            if (!swept_.contains(place(i) + point)) {
                return false;
            }
        }
    }
    if (!is_path_clear(walls_, line_edge(from, to), wall_clearance_ + kMargin * radius_)) {
        return false;
    }
    for (int i = 0; i < n; ++i) {
        if (swept_.engagement(place(i), heading, kRoom * radius_) >= kNone) {
            return false;
        }
    }
    return true;
}

bool KeepDownLinks::is_free(Node node)
{
    if (known_free_.count(node) != 0) {
        return true;
    }
    if (!is_room(place_of(node))) {
        return false;
    }
    known_free_.insert(node);
    return true;
}

// The way meets hardly any stock.
bool KeepDownLinks::is_open(Vec2d from, Vec2d to) const
{
    const offset::Edge way = line_edge(from, to);
    return is_path_clear(walls_, way, wall_clearance_) && swept_.keeps(way, kMet);
}

// The nearest of a few places around with room, to be reached by a straight move.
std::optional<Vec2d> KeepDownLinks::beside(Vec2d place) const
{
    if (is_room(place)) {
        return place;
    }
    for (const double far : kBeside) {
        for (int i = 0; i < kSides; ++i) {
            const double angle = 2 * kPi * i / kSides;
            const Vec2d p =
                place + Vec2d{elementary::cos(angle), elementary::sin(angle)} * (far * radius_);
            if (is_room(p) && is_open(place, p)) {
                return p;
            }
        }
    }
    return std::nullopt;
}

std::optional<offset::Edge> KeepDownLinks::approach(Vec2d start) const
{
    if (swept_.engagement(start, {1.0, 0.0}, -kCusp * radius_, kPi) < kNone) {
        return std::nullopt;
    }
    const std::optional<Vec2d> place = beside(start);
    return place ? std::optional{line_edge(*place, start)} : std::nullopt;
}

std::vector<LinkLeg> KeepDownLinks::between(Vec2d from, Vec2d to)
{
    const double size = norm(to - from);
    if (size < radius_ && is_open(from, to)) {
        return {{to, false}};
    }
    const std::optional<Vec2d> first = beside(from);
    const std::optional<Vec2d> last = beside(to);
    std::vector<Vec2d> places;
    if (first && last && norm(*last - *first) < kSamePlace * radius_) {
        return {{*first, false}, {to, false}};
    }
    if (first && last) {
        places = is_free(*first, *last) ? std::vector<Vec2d>{*first, *last} : way(*first, *last);
    }
    std::vector<LinkLeg> legs;
    if (places.empty()) {
        if (size < 20.0 * radius_ && is_open(from, to)) {
            legs.push_back({to, false});
        }
        return legs;
    }
    legs.push_back({places.front(), false, swept_.keeps(line_edge(from, places.front()), kNone)});
    for (std::size_t i = 1; i < places.size(); ++i) {
        legs.push_back({places[i], true});
    }
    legs.push_back({to, false});
    return legs;
}

KeepDownLinks::Node KeepDownLinks::node_at(Vec2d place) const
{
    const auto at = [&](double x) {
        return static_cast<Node>(std::llround(x / pitch_) + kHalf);
    };
    return (at(place.x) << 32U) | at(place.y);
}

Vec2d KeepDownLinks::place_of(Node node) const
{
    const auto at = [&](Node i) {
        return static_cast<double>(static_cast<std::int64_t>(i) - kHalf) * pitch_;
    };
    return {at(node >> 32U), at(node & 0xffffffffU)};
}

// A* on the lattice; empty where none is short.
std::vector<Vec2d> KeepDownLinks::way(Vec2d from, Vec2d to)
{
    struct Reached {
        double gone;
        Node before;
        bool done;
    };
    const Node first = node_at(from);
    const Node last = node_at(to);
    std::unordered_map<Node, Reached> reached;
    using Open = std::tuple<double, Node>;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    reached[first] = {0.0, first, false};
    open.emplace(norm(to - from), first);
    while (!open.empty() && reached.size() < kMostNodes) {
        const auto [whole, node] = open.top();
        open.pop();
        if (whole > kLongest * radius_) {
            break;
        }
        Reached& here = reached[node];
        if (here.done) {
            continue;
        }
        here.done = true;
        if (node == last) {
            std::vector<Vec2d> places{to};
            for (Node n = node; n != first; n = reached[n].before) {
                places.push_back(place_of(n));
            }
            places.push_back(from);
            std::reverse(places.begin(), places.end());
            return straightened(places);
        }
        const double gone = here.gone;
        for (int k = 0; k < 9; ++k) {
            const Vec2d place = place_of(node) + Vec2d{k % 3 - 1.0, k / 3 - 1.0} * pitch_;
            const Node next = node_at(place);
            const double far = gone + norm(place - place_of(node));
            const auto known = reached.find(next);
            if (known != reached.end() && known->second.gone <= far) {
                continue;
            }
            if (known == reached.end() && next != last && !is_free(next)) {
                reached[next] = {-kUnbounded, node, true};
                continue;
            }
            reached[next] = {far, node, false};
            open.emplace(far + norm(to - place), next);
        }
    }
    return {};
}

// The farthest place that is straight ahead, from place to place; empty where two neighbours have
// no free way between them.
std::vector<Vec2d> KeepDownLinks::straightened(const std::vector<Vec2d>& places) const
{
    std::vector<Vec2d> result{places.front()};
    std::size_t at = 0;
    while (at + 1 < places.size()) {
        std::size_t next = places.size() - 1;
        while (next > at && !is_free(places[at], places[next])) {
            next = at + (next - at) / 2;
        }
        if (next == at) {
            return {};
        }
        result.push_back(places[next]);
        at = next;
    }
    return result;
}

}  // namespace cusp::adaptive_clearing
