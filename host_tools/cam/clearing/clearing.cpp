// Makes the rings of loops, orders them and selects how each pass starts.
#include "host_tools/cam/clearing/clearing.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/cam/clearing/corner_cleanup.hpp"
#include "host_tools/cam/clearing/cutting_order.hpp"
#include "host_tools/cam/clearing/loop_links.hpp"
#include "host_tools/cam/clearing/partial_loops.hpp"

namespace cusp::clearing {

using job::CutDirection;
using offset::area;
using offset::Contour;
using offset::length;
using offset::Region2d;
using offset::RegionOffset;
using offset::reversed;
using offset::surrounds;

namespace {

constexpr double kShare = 0.4995;  // of a step: width cut on either side of a pass

struct Loop2d {
    Contour path;
    int ring;
    double distance;
    double step;
    bool outer;
};

// The next ring inward: at a whole step if cleanup spurs into the corners leave nothing between,
// else at the largest share of it for which they do.
struct NextRing {
    double distance;
    Region2d loops;
    bool by_corners{};  // limited by corners: a larger step would leave stock in them
};

NextRing next_ring(const RegionOffset& offset, double distance, double step, bool cover)
{
    if (!cover) {
        return {distance + step, offset.at(distance + step)};
    }
    const double reach = kShare * step;
    const Region2d rest = offset.at(distance + reach);
    const auto at_share = [&](double share) {
        return with_corner_cleanup(offset.at(distance + share * step), rest, offset,
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
        auto found = at_share(middle);
        if (found) {
            best = std::move(found);
            good = middle;
        } else {
            bad = middle;
        }
    }
    return {distance + good * step, std::move(*best), true};
}

// Moves the inner ring nearer until the scallop between is low enough, or farther if it is lower
// than allowed. Returns its share of the allowed height; 0 if that is not given.
double fit_distance(NextRing& inner,
                    const NextRing& ring,
                    const RegionOffset& offset,
                    const ClearingSettings& settings)
{
    constexpr int kRounds = 14;
    constexpr double kMost = 0.999;  // of the last step
    constexpr double kMostAgain = 0.98;
    constexpr double kLeast = 0.5;
    constexpr double kLittle = 0.85;  // of the allowed height
    constexpr double kWider = 0.97;
    const double widest = 0.5 * settings.stepover;
    std::optional<NextRing> good;
    double good_left = 0.0;
    bool bad = false;  // a step with too high a scallop was tried
    for (int round = 0; settings.scallop_share_between && round < kRounds; ++round) {
        const double step = inner.distance - ring.distance;
        const double left = settings.scallop_share_between(
            {ring.loops, inner.loops, ring.distance, inner.distance, offset});
        const double largest = round == 0 ? kMost : kMostAgain;
        double share = std::clamp(kMost / std::sqrt(left), kLeast, largest);
        if (left <= 1.0) {
            good = std::move(inner);
            good_left = left;
            share = std::min(kWider / std::sqrt(left), 2.0);
            const bool free = !good->by_corners && !bad;
            if (left > kLittle || !free || step * share > widest) {
                break;
            }
        } else if (good) {
            break;
        } else {
            bad = true;
        }
        inner = next_ring(offset, ring.distance, share * step, settings.cover_corners);
    }
    if (good) {
        inner = std::move(*good);
    }
    return good_left;
}

// A ring farther inward than `stepover`, with partial loops before it, if that makes the path
// shorter.
struct RingAfterPartialLoops {
    NextRing ring;
    std::vector<PartialLoop> loops;
    double cost;   // mm of path per mm of depth
    double saved;  // mm of path
};

std::optional<RingAfterPartialLoops> ring_after_partial_loops(const NextRing& ring,
                                                              double step,
                                                              const RegionOffset& offset,
                                                              const ClearingSettings& settings,
                                                              bool& tried)
{
    constexpr double kWorthIt = 0.9;
    constexpr double kMany = 0.5;  // of the ring's length: a nearer ring may need fewer
    constexpr double kNearer = 0.9;
    constexpr int kRounds = 3;
    double wide = settings.partial_stepover ? settings.partial_stepover(ring.loops, step) : 0.0;
    double whole = 0.0;
    for (const Contour& contour : ring.loops.contours) {
        whole += length(contour);
    }
    std::optional<RingAfterPartialLoops> best;
    for (int round = 0; round < kRounds && wide > step; ++round) {
        NextRing inner = next_ring(offset, ring.distance, std::min(wide, settings.stepover),
                                   settings.cover_corners);
        const double apart = inner.distance - ring.distance;
        if (apart <= step) {
            break;
        }
        tried = true;
        wide = kNearer * apart;
        const double max_length = (best ? best->cost : kWorthIt * whole / step) * apart - whole;
        auto partial = settings.partial_loops(
            {ring.loops, inner.loops, ring.distance, inner.distance, offset}, max_length);
        if (!partial) {
            continue;
        }
        const double added = added_length(*partial);
        const double cost = (whole + added) / apart;
        best = RingAfterPartialLoops{std::move(inner), std::move(*partial), cost,
                                     (whole / step - cost) * apart};
        if (added < kMany * whole) {
            break;
        }
    }
    return best;
}

// Adds partial loops, and the length that they save, to the result.
//
// Over 60 lines: each ring depends on the step, the factor and the trials of the ring before.
std::vector<Loop2d> make_rings(const RegionOffset& offset,
                               const ClearingSettings& settings,
                               ClearedRegion& result)
{
    std::vector<Loop2d> loops;
    const auto step_from = [&](const Region2d& ring) {
        const double asked =
            settings.stepover_from ? settings.stepover_from(ring) : settings.stepover;
        return std::min(asked, settings.stepover);
    };
    // The factor for one ring mostly suits the next one, which is first tried at that share of its
    // stepover.
    constexpr double kMostAgain = 1.5;
    constexpr double kLeastSuited = 0.1;
    constexpr double kMostSuited = 2.0;
    double suited = 1.0;
    const auto drawn_from = [&](const NextRing& ring, double step) {
        const double first = std::min(suited * step, std::max(step, 0.5 * settings.stepover));
        return next_ring(offset, ring.distance, first, settings.cover_corners);
    };
    // If partial loops do not pay they seldom do at the next ring.
    int next_try = 0;
    int wait = 1;
    NextRing ring{settings.wall_clearance, offset.at(settings.wall_clearance)};
    double step = ring.loops.contours.empty() ? 0.0 : step_from(ring.loops);
    for (int k = 0; k < kMaxRings && !ring.loops.contours.empty(); ++k) {
        const auto add_ring = [&](NextRing& inner) {
            for (Contour& contour : ring.loops.contours) {
                const bool outer = area(contour) > 0.0;
                loops.push_back(
                    {std::move(contour), k, ring.distance, inner.distance - ring.distance, outer});
            }
            ring = std::move(inner);
        };
        NextRing inner = drawn_from(ring, step);
        double inner_step = step;
        // The step must suit the loops on both of its sides. Loops that move by less than a
        // fiftieth of it are not checked again; a thousandth is subtracted for that.
        constexpr double kAlike = 0.98;
        constexpr double kMargin = 0.999;
        for (int round = 0; round < 4 && !inner.loops.contours.empty(); ++round) {
            inner_step = step_from(inner.loops);
            if (inner_step >= kMargin * step) {
                break;
            }
            const bool alike = inner_step >= kAlike * step;
            step = alike ? kMargin * inner_step : inner_step;
            inner = drawn_from(ring, step);
            if (alike) {
                break;
            }
        }
        std::optional<RingAfterPartialLoops> far;
        if (k >= next_try) {
            bool tried = false;
            far = ring_after_partial_loops(ring, suited * step, offset, settings, tried);
            wait = far ? 1 : (tried ? 2 * wait : wait);
            next_try = k + (tried ? wait : 1);
        }
        if (far) {
            if (far->loops.empty() && settings.scallop_share_between) {
                suited = std::clamp((far->ring.distance - ring.distance) / step, kLeastSuited,
                                    kMostSuited);
            }
            for (PartialLoop& loop : far->loops) {
                loop.ring = k;
                result.partial.push_back(std::move(loop));
            }
            result.saved += far->saved;
            add_ring(far->ring);
            step = ring.loops.contours.empty() ? 0.0 : step_from(ring.loops);
            continue;
        }
        const double left = fit_distance(inner, ring, offset, settings);
        if (left > 0.0 && !inner.by_corners) {
            const double drawn = (inner.distance - ring.distance) / step;
            suited = std::clamp(drawn * std::min(1.0 / std::sqrt(left), kMostAgain), kLeastSuited,
                                kMostSuited);
        }
        add_ring(inner);
        step = inner_step;
    }
    return loops;
}

// The parent of each loop: the tightest loop of the ring before that contains it. For rings around
// islands it is reversed: the parent of a ring is the wider ring of the next level.
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
            const int apart = outer ? loop.ring - other.ring : other.ring - loop.ring;
            if (apart == 1 && surrounds(other.path, probe)) {
                parent = static_cast<int>(j);
            }
        }
        parents.push_back(parent);
    }
    return parents;
}

class PassList {
public:
    PassList(const RegionOffset& offset, const ClearingSettings& settings)
        : offset_{offset}, settings_{settings}
    {
    }

    // fresh   no pass beside this one has been cut
    // beside  the loop may be linked to the pass before
    void add(const Loop2d& loop, bool fresh)
    {
        ClearingPass pass;
        pass.path = loop.path;
        pass.ring = loop.ring;
        pass.offset = loop.distance;
        pass.around_island = !loop.outer;
        pass.stepover = loop.step;
        if (settings_.direction == CutDirection::kConventional) {
            pass.path = reversed(pass.path);
        }
        if (fresh || region_.passes.empty()) {
            start_at_longest(pass.path);
            region_.leaves += loop.outer ? 1 : 0;
        } else {
            link_to(pass, region_.passes.back().path,
                    {offset_, settings_.wall_clearance, settings_.stepover});
        }
        pass.wall_distance = offset_.clearance(pass.path.front().start);
        region_.rings = std::max(region_.rings, loop.ring + 1);
        region_.passes.push_back(std::move(pass));
    }

    ClearedRegion& region() { return region_; }

private:
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
    PassList list{offset, settings};
    const std::vector<Loop2d> loops = make_rings(offset, settings, list.region());
    add_rings(loops, list);
    add_trees(loops, list);
    ClearedRegion result = std::move(list.region());
    result.direction = settings.direction;
    for (const ClearingPass& pass : result.passes) {
        result.widest_gap = std::max(result.widest_gap, pass.stepover);
    }
    return result;
}

}  // namespace cusp::clearing
