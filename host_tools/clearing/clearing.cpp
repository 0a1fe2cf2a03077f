// Makes the levels of loops, orders them and decides how each pass starts.
#include "host_tools/clearing/clearing.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/clearing/corner_spurs.hpp"
#include "host_tools/clearing/cutting_order.hpp"
#include "host_tools/clearing/link_along.hpp"
#include "host_tools/offset/contour_fit.hpp"

namespace cusp::host {

namespace {

constexpr double kShare = 0.4995;  // of a step: how far from a pass metal is cut by it

struct Loop2d {
    Contour path;
    int level;
    double distance;
    double step;
    bool outer;
};

// The next level inward: a whole step where spurs into the corners leave nothing between, else the
// farthest share of it where they do.
struct NextLevel {
    double distance;
    Region2d loops;
    bool by_corners{};  // a farther one would leave something in corners
};

NextLevel next_level(const RegionOffset& offset, double distance, double step, bool cover)
{
    if (!cover) {
        return {distance + step, offset.at(distance + step)};
    }
    const double reach = kShare * step;
    const Region2d rest = offset.at(distance + reach);
    const auto at_share = [&](double share) {
        return with_corner_spurs(offset.at(distance + share * step), rest, offset,
                                 {distance, reach, share * step - reach});
    };
    constexpr double kWhole = 2.0 * kShare;
    auto best = rest.contours.empty() ? Region2d{} : at_share(kWhole);
    if (best) {
        return {distance + kWhole * step, std::move(*best)};
    }
    double good = kShare;
    double bad = kWhole;
    best = rest;
    for (int i = 0; i < 5; ++i) {
        const double middle = 0.5 * (good + bad);
        auto level = at_share(middle);
        if (level) {
            best = std::move(level);
            good = middle;
        } else {
            bad = middle;
        }
    }
    return {distance + good * step, std::move(*best), true};
}

// Draws the inner level nearer until little enough stays between, or farther off, where less stays
// than may. Returns what stays as a share of what may; 0 where that is not asked.
double draw_to_suit(NextLevel& inner,
                    const NextLevel& level,
                    const RegionOffset& offset,
                    const ClearingSettings& settings)
{
    constexpr int kRounds = 14;
    constexpr double kMost = 0.999;  // of the step before
    constexpr double kMostAgain = 0.98;
    constexpr double kLeast = 0.5;
    constexpr double kLittle = 0.85;  // of what may stay
    constexpr double kWider = 0.97;
    const double widest = 0.5 * settings.step;
    std::optional<NextLevel> good;
    double good_left = 0.0;
    double bad = 1e300;
    for (int round = 0; settings.left_between && round < kRounds; ++round) {
        const double step = inner.distance - level.distance;
        const double left = settings.left_between(
            {level.loops, inner.loops, level.distance, inner.distance, offset});
        const double most = round == 0 ? kMost : kMostAgain;
        double share = std::clamp(kMost / std::sqrt(left), kLeast, most);
        if (left <= 1.0) {
            good = std::move(inner);
            good_left = left;
            share = std::min(kWider / std::sqrt(left), 2.0);
            const bool free = !good->by_corners && bad == 1e300;
            if (left > kLittle || !free || step * share > widest) {
                break;
            }
        } else if (good) {
            break;
        } else {
            bad = step;
        }
        inner = next_level(offset, level.distance, share * step, settings.cover_corners);
    }
    if (good) {
        inner = std::move(*good);
    }
    return good_left;
}

std::vector<Loop2d> make_levels(const RegionOffset& offset, const ClearingSettings& settings)
{
    std::vector<Loop2d> loops;
    const auto step_from = [&](const Region2d& level) {
        const double asked = settings.step_from ? settings.step_from(level) : settings.step;
        return std::min(asked, settings.step);
    };
    // What makes a level lie nearer or farther than asked seldom ends with it: the next one is
    // first drawn where that much would have suited the last one.
    constexpr double kMostAgain = 1.5;
    constexpr double kLeastSuited = 0.1;
    constexpr double kMostSuited = 2.0;
    double suited = 1.0;
    const auto drawn_from = [&](const NextLevel& level, double step) {
        const double first = std::min(suited * step, std::max(step, 0.5 * settings.step));
        return next_level(offset, level.distance, first, settings.cover_corners);
    };
    NextLevel level{settings.first, offset.at(settings.first)};
    double step = level.loops.contours.empty() ? 0.0 : step_from(level.loops);
    for (int k = 0; k < kMostLevels && !level.loops.contours.empty(); ++k) {
        NextLevel inner = drawn_from(level, step);
        double inner_step = step;
        // The step must suit the loops on both of its sides. Loops that move by a fiftieth of it
        // are not looked at again: a thousandth is taken off for that.
        constexpr double kAlike = 0.98;
        constexpr double kMargin = 0.999;
        for (int round = 0; round < 4 && !inner.loops.contours.empty(); ++round) {
            inner_step = step_from(inner.loops);
            if (inner_step >= kMargin * step) {
                break;
            }
            const bool alike = inner_step >= kAlike * step;
            step = alike ? kMargin * inner_step : inner_step;
            inner = drawn_from(level, step);
            if (alike) {
                break;
            }
        }
        const double left = draw_to_suit(inner, level, offset, settings);
        if (left > 0.0 && !inner.by_corners) {
            const double drawn = (inner.distance - level.distance) / step;
            suited = std::clamp(drawn * std::min(1.0 / std::sqrt(left), kMostAgain), kLeastSuited,
                                kMostSuited);
        }
        for (Contour& contour : level.loops.contours) {
            const bool outer = area(contour) > 0.0;
            loops.push_back(
                {std::move(contour), k, level.distance, inner.distance - level.distance, outer});
        }
        level = std::move(inner);
        step = inner_step;
    }
    return loops;
}

// The parent of each loop: the tightest loop of the level before that it lies in. For rings around
// islands it is turned round: the parent of a ring is the wider ring of the next level.
std::vector<int> parents_of(const std::vector<Loop2d>& loops,
                            const std::vector<int>& chosen,
                            bool outer)
{
    std::vector<int> parents;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const Loop2d& loop = loops[static_cast<std::size_t>(chosen[i])];
        const Vec2d probe = point_on(loop.path.front(), 0.5);
        int parent = -1;
        for (std::size_t j = 0; j < i; ++j) {
            const Loop2d& other = loops[static_cast<std::size_t>(chosen[j])];
            const int apart = outer ? loop.level - other.level : other.level - loop.level;
            if (apart == 1 && surrounds(other.path, probe)) {
                parent = static_cast<int>(j);
            }
        }
        parents.push_back(parent);
    }
    return parents;
}

// Turns the loop so that it starts at the point of it nearest to `from`.
void start_near(Contour& path, Vec2d from)
{
    std::size_t best = 0;
    double least = 1e300;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const double apart = distance_to(path[i], from);
        if (apart < least) {
            least = apart;
            best = i;
        }
    }
    const Edge edge = path[best];
    const Vec2d p = nearest_on(edge, from);
    std::rotate(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(best), path.end());
    constexpr double kShortest = 1e-3;
    if (distance(p, edge.start) < kShortest) {
        return;
    }
    if (distance(p, edge.end) < kShortest) {
        std::rotate(path.begin(), path.begin() + 1, path.end());
        return;
    }
    path.front() = between(edge, p, edge.end);
    path.push_back(between(edge, edge.start, p));
}

// The middle of the longest edge: an entry there has room on both sides.
void start_at_longest(Contour& path)
{
    const auto longest =
        std::max_element(path.begin(), path.end(),
                         [](const Edge& a, const Edge& b) { return length(a) < length(b); });
    start_near(path, point_on(*longest, 0.5));
}

// How near contours are changes by no more than the way between two places.
bool free_path(const RegionOffset& offset, const std::vector<Edge>& path, double distance)
{
    constexpr double kSpacing = 0.1;
    constexpr double kFar = 5.0;
    for (const Edge& edge : path) {
        const double whole = length(edge);
        const int samples = 1 + static_cast<int>(whole / kSpacing);
        for (int i = 0; i <= samples;) {
            const Vec2d p = point_on(edge, static_cast<double>(i) / samples);
            const double room = offset.nearest(p, distance + kFar) - (distance - 1e-5);
            if (room < 0.0) {
                return false;
            }
            i += 1 + static_cast<int>(room * samples / std::max(whole, kSpacing));
        }
    }
    return true;
}

class PassList {
public:
    PassList(const RegionOffset& offset, const ClearingSettings& settings)
        : offset_{offset}, settings_{settings}
    {
    }

    // fresh: no pass beside this one has been cut. beside: the loop may be linked to the pass
    // before.
    void add(const Loop2d& loop, bool fresh)
    {
        ClearingPass pass;
        pass.path = loop.path;
        pass.level = loop.level;
        pass.distance = loop.distance;
        pass.around_island = !loop.outer;
        pass.step = loop.step;
        if (settings_.direction == CutDirection::kConventional) {
            pass.path = reversed(pass.path);
        }
        if (fresh || region_.passes.empty()) {
            start_at_longest(pass.path);
            region_.leaves += loop.outer ? 1 : 0;
        } else {
            reach(pass, region_.passes.back().path);
        }
        pass.room = offset_.clearance(pass.path.front().start);
        region_.levels = std::max(region_.levels, loop.level + 1);
        region_.passes.push_back(std::move(pass));
    }

    ClearedRegion& region() { return region_; }

private:
    // From the end of the pass before, tangent to both where that is free, else straight to the
    // nearest point, else along the pass before to where this one is near.
    void reach(ClearingPass& pass, const Contour& before) const
    {
        const Vec2d from = before.front().start;
        const Vec2d leaving = tangent_at_end(before.back());
        // Steps that the link gains on its way over: fewer where the pass soon turns away.
        for (const double ahead : {2.0, 1.4, 1.0, 0.7, 2.8}) {
            start_near(pass.path, from + leaving * (ahead * pass.step));
            const Vec2d to = pass.path.front().start;
            const auto arcs = biarc_between(from, leaving, to, tangent_at_start(pass.path.front()));
            const bool onward = dot(to - from, leaving) > 0.5 * ahead * pass.step;
            if (arcs && onward && distance(from, to) < 4.0 * pass.step) {
                pass.link = {arcs->front(), arcs->back()};
                if (free_path(offset_, pass.link, settings_.first)) {
                    break;
                }
                pass.link.clear();
            }
        }
        if (pass.link.empty()) {
            start_near(pass.path, from);
            pass.link = {line_edge(from, pass.path.front().start)};
        }
        const bool near = length(pass.link) < 5.0 * settings_.step;
        const bool linked =
            (near && free_path(offset_, pass.link, settings_.first)) || reach_along(pass, before);
        pass.start = linked ? PassStart::kLink : PassStart::kDrop;
    }

    bool reach_along(ClearingPass& pass, const Contour& before) const
    {
        constexpr double kFarthest = 1.5;  // of the step between neighbours
        const std::vector<Edge> link = link_along(before, pass.path, kFarthest * pass.step);
        if (link.empty() || !free_path(offset_, {link.back()}, settings_.first)) {
            return false;
        }
        start_near(pass.path, link.back().end);
        pass.link = link;
        pass.link.back() = line_edge(link.back().start, pass.path.front().start);
        return true;
    }

    const RegionOffset& offset_;
    const ClearingSettings& settings_;
    ClearedRegion region_;
};

// Rings around islands, the widest first, each followed by the narrower ones inside it.
void add_rings(const std::vector<Loop2d>& loops, PassList& list)
{
    std::vector<int> rings;
    for (std::size_t i = loops.size(); i-- > 0;) {
        if (!loops[i].outer) {
            rings.push_back(static_cast<int>(i));
        }
    }
    const std::vector<int> parents = parents_of(loops, rings, false);
    std::vector<std::vector<int>> inside(rings.size());
    std::vector<int> stack;
    for (std::size_t i = rings.size(); i-- > 0;) {
        if (parents[i] < 0) {
            stack.push_back(static_cast<int>(i));
        } else {
            inside[static_cast<std::size_t>(parents[i])].push_back(static_cast<int>(i));
        }
    }
    while (!stack.empty()) {
        const auto at = static_cast<std::size_t>(stack.back());
        stack.pop_back();
        list.add(loops[static_cast<std::size_t>(rings[at])], parents[at] < 0);
        stack.insert(stack.end(), inside[at].begin(), inside[at].end());
    }
}

void add_trees(const std::vector<Loop2d>& loops, PassList& list)
{
    std::vector<int> outer;
    for (std::size_t i = 0; i < loops.size(); ++i) {
        if (loops[i].outer) {
            outer.push_back(static_cast<int>(i));
        }
    }
    const std::vector<int> parents = parents_of(loops, outer, true);
    std::vector<bool> has_child(outer.size(), false);
    for (const int parent : parents) {
        if (parent >= 0) {
            has_child[static_cast<std::size_t>(parent)] = true;
        }
    }
    for (const int node : cutting_order(parents)) {
        const auto at = static_cast<std::size_t>(node);
        list.add(loops[static_cast<std::size_t>(outer[at])], !has_child[at]);
    }
}

}  // namespace

ClearedRegion clear_region(const Region2d& region, const ClearingSettings& settings)
{
    const RegionOffset offset{region};
    const std::vector<Loop2d> loops = make_levels(offset, settings);
    PassList list{offset, settings};
    add_rings(loops, list);
    add_trees(loops, list);
    ClearedRegion result = std::move(list.region());
    for (const ClearingPass& pass : result.passes) {
        result.widest_gap = std::max(result.widest_gap, pass.step);
    }
    return result;
}

}  // namespace cusp::host
