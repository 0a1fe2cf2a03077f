// A grid of squares finds neighbouring ends. Chains are followed from open ends first, then closed
// loops. Open chains are joined in a second step, across gaps up to the tolerance.
#include "host_tools/import/loop_nesting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "host_tools/job/loop_shape.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::ClosedLoop;
using job::crossing_of;
using job::encloses;
using job::loop_polyline;
using job::LoopNesting;
using job::OpenChain;
using nurbs::Curve;
using nurbs::CurvePoint;

namespace {

constexpr double kOutline = 1e-3;           // mm, of chords
constexpr double kRepeated = 1e-4;          // mm: distance below which curves are duplicates
constexpr std::size_t kMostSides = 200000;  // limit of the search for crossings

// Curves in order; each starts at the end of the previous one.
using Chain = std::vector<Curve>;

struct End {
    std::size_t chain;
    bool last;  // of the chain
    Vec2d at;
};

// Spatial hash of curve ends.
class EndGrid {
public:
    explicit EndGrid(double side) : side_{side} {}
    void add(std::size_t number, Vec2d at) { squares_[key(at, 0, 0)].push_back(number); }

    // Calls visit(number) for all ends in the 3 x 3 squares around a point.
    template <class Visit>
    void near(Vec2d at, const Visit& visit) const
    {
        for (int i = -1; i <= 1; ++i) {
            for (int j = -1; j <= 1; ++j) {
                if (const auto found = squares_.find(key(at, i, j)); found != squares_.end()) {
                    std::for_each(found->second.begin(), found->second.end(), visit);
                }
            }
        }
    }

private:
    std::uint64_t key(Vec2d at, int i, int j) const
    {
        const auto column = static_cast<std::int64_t>(std::floor(at.x / side_)) + i;
        const auto row = static_cast<std::int64_t>(std::floor(at.y / side_)) + j;
        return static_cast<std::uint64_t>(column) * 0x9E3779B97F4A7C15U ^
               static_cast<std::uint64_t>(row);
    }

    double side_;
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> squares_;
};

struct Measures {
    double length{};
    double area{};  // signed, of the sector from the origin
};

// Gauss-Legendre quadrature with eight points on each span.
Measures measures_of(const Curve& curve, Vec2d origin)
{
    constexpr std::array<double, 4> kPlaces{0.1834346424956498, 0.5255324099163290,
                                            0.7966664774136267, 0.9602898564975363};
    constexpr std::array<double, 4> kWeights{0.3626837833783620, 0.3137066458778873,
                                             0.2223810344533745, 0.1012285362903763};
    Measures sum;
    for (const Curve& piece : bezier_pieces(curve)) {
        const double half = (piece.domain_end() - piece.domain_begin()) / 2;
        const double middle = (piece.domain_end() + piece.domain_begin()) / 2;
        for (std::size_t k = 0; k < 2 * kPlaces.size(); ++k) {
            const double side = k % 2 == 0 ? 1.0 : -1.0;
            const CurvePoint p = derivatives_at(piece, middle + side * half * kPlaces[k / 2]);
            const double weight = half * kWeights[k / 2];
            sum.length += weight * norm(in_plan(p.first));
            sum.area += weight * cross(in_plan(p.point) - origin, in_plan(p.first)) / 2;
        }
    }
    return sum;
}

Chain reversed_chain(const Chain& chain)
{
    Chain back;
    for (auto curve = chain.rbegin(); curve != chain.rend(); ++curve) {
        back.push_back(reversed(*curve));
    }
    return back;
}

// Joins chains whose ends meet.
class Joining {
public:
    // meets  mm: largest distance of ends that meet
    Joining(const std::vector<Chain>& chains, double meets)
        : chains_{chains}, meets_{meets}, grid_{meets}, used_(chains.size(), false)
    {
        for (std::size_t k = 0; k < chains.size(); ++k) {
            for (const bool last : {false, true}) {
                const Vec3d at =
                    last ? chains[k].back().points.back() : chains[k].front().points.front();
                grid_.add(ends_.size(), in_plan(at));
                ends_.push_back({k, last, in_plan(at)});
            }
        }
    }

    // Returns the chains that remain open.
    std::vector<Chain> sort_into(LoopNesting& nesting)
    {
        // Open chains first, from their ends; what remains is closed.
        for (const bool from_open_ends : {true, false}) {
            for (std::size_t e = 0; e < ends_.size(); ++e) {
                if (!used_[ends_[e].chain] && (!from_open_ends || is_open(e))) {
                    add_chain(e, nesting);
                }
            }
        }
        return std::move(open_);
    }

private:
    // The nearest end of an unused chain that meets this one; ends_.size(): there is none.
    std::size_t next_to(std::size_t end) const
    {
        std::size_t nearest = ends_.size();
        double least = meets_;
        grid_.near(ends_[end].at, [&](std::size_t other) {
            const double apart = norm(ends_[other].at - ends_[end].at);
            if (other != end && !used_[ends_[other].chain] && apart <= least) {
                least = apart;
                nearest = other;
            }
        });
        return nearest;
    }
    bool is_open(std::size_t end) const
    {
        bool meets = false;
        grid_.near(ends_[end].at, [&](std::size_t other) {
            meets = meets || (other != end && norm(ends_[other].at - ends_[end].at) <= meets_);
        });
        return !meets;
    }

    void note_gap(double gap, LoopNesting& nesting) const
    {
        if (gap > kEndsMeet) {
            ++nesting.bridged;
            nesting.widest_gap = std::max(nesting.widest_gap, gap);
        }
    }

    void add_chain(std::size_t first, LoopNesting& nesting)
    {
        Chain chain;
        const Vec2d begin = ends_[first].at;
        Vec2d end = begin;
        Measures sum;
        bool closed = false;
        for (std::size_t at = first; at < ends_.size();) {
            const End& from = ends_[at];
            used_[from.chain] = true;
            const Chain& next = chains_[from.chain];
            Chain turned = from.last ? reversed_chain(next) : next;
            for (Curve& curve : turned) {
                const Measures one = measures_of(curve, begin);
                sum.length += one.length;
                sum.area += one.area;
                chain.push_back(std::move(curve));
            }
            const std::size_t other = at ^ 1U;
            end = ends_[other].at;
            closed = norm(end - begin) <= meets_ && sum.length > 2 * meets_;
            at = closed ? ends_.size() : next_to(other);
            if (at < ends_.size()) {
                note_gap(norm(ends_[at].at - end), nesting);
            }
        }
        if (closed) {
            note_gap(norm(end - begin), nesting);
            const std::vector<Vec2d> outline = loop_polyline(chain, kOutline);
            nesting.loops.push_back({std::move(chain), outline, sum.length, std::abs(sum.area),
                                     sum.area > 0, -1, 0, std::nullopt});
            return;
        }
        open_.push_back(std::move(chain));
    }

    const std::vector<Chain>& chains_;
    double meets_;
    EndGrid grid_;
    std::vector<End> ends_;
    std::vector<bool> used_;
    std::vector<Chain> open_;
};

OpenChain open_chain(const Chain& chain)
{
    double length = 0;
    for (const Curve& curve : chain) {
        length += measures_of(curve, {}).length;
    }
    const Vec2d begin = in_plan(chain.front().points.front());
    const Vec2d end = in_plan(chain.back().points.back());
    // loop_polyline() closes the chain
    std::vector<Vec2d> outline = loop_polyline(chain, kOutline);
    outline.back() = end;
    return {outline, chain.size(), length, begin, end, 0, begin, end};
}

void measure_gaps(std::vector<OpenChain>& open)
{
    std::vector<Vec2d> ends;
    for (const OpenChain& chain : open) {
        ends.push_back(chain.begin);
        ends.push_back(chain.end);
    }
    // Sorted by x, so that only ends within the least gap so far are examined.
    std::vector<std::size_t> order(ends.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(ends[a].x, a) < std::tie(ends[b].x, b);
    });
    std::vector<double> gaps(open.size(), kInfinite);
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::size_t from = order[i];
        OpenChain& chain = open[from / 2];
        const auto look = [&](std::size_t k) {
            const double gap = norm(ends[order[k]] - ends[from]);
            if (gap < gaps[from / 2]) {
                gaps[from / 2] = chain.gap = gap;
                chain.gap_from = ends[from];
                chain.gap_to = ends[order[k]];
            }
            return std::abs(ends[order[k]].x - ends[from].x) <= gaps[from / 2];
        };
        for (std::size_t k = i + 1; k < order.size() && look(k); ++k) {
        }
        for (std::size_t k = i; k-- > 0 && look(k);) {
        }
    }
}

struct PlanBox {
    Vec2d low, high;
    bool holds(const PlanBox& other) const
    {
        return low.x <= other.low.x && low.y <= other.low.y && high.x >= other.high.x &&
               high.y >= other.high.y;
    }
};

PlanBox box_of(const std::vector<Vec2d>& outline)
{
    PlanBox box{outline.front(), outline.front()};
    for (const Vec2d p : outline) {
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
    }
    return box;
}

// A majority of three points decides, since loops may touch.
bool lies_in(const std::vector<Vec2d>& inner, const std::vector<Vec2d>& outer)
{
    const std::size_t n = inner.size() - 1;
    int inside = 0;
    for (const std::size_t k : {std::size_t{0}, n / 3, 2 * n / 3}) {
        inside += encloses(outer, 0.5 * (inner[k] + inner[k + 1])) ? 1 : 0;
    }
    return inside >= 2;
}

// Precondition: loops are sorted by area, the largest first.
void nest(std::vector<ClosedLoop>& loops)
{
    std::vector<PlanBox> boxes;
    for (std::size_t i = 0; i < loops.size(); ++i) {
        boxes.push_back(box_of(loops[i].outline));
        for (std::size_t k = i; k-- > 0;) {
            if (boxes[k].holds(boxes[i]) && lies_in(loops[i].outline, loops[k].outline)) {
                loops[i].parent = static_cast<int>(k);
                loops[i].depth = loops[k].depth + 1;
                break;
            }
        }
    }
}

void find_crossings(LoopNesting& nesting)
{
    std::vector<std::vector<Vec2d>> outlines;
    std::size_t sides = 0;
    for (const ClosedLoop& loop : nesting.loops) {
        outlines.push_back(loop.outline);
        sides += loop.outline.size();
    }
    if (sides > kMostSides || !(nesting.crossing = crossing_of(outlines))) {
        return;
    }
    bool own = false;
    for (ClosedLoop& loop : nesting.loops) {
        loop.crossing = crossing_of({loop.outline});
        own = own || loop.crossing;
    }
    if (own) {
        nesting.crossing.reset();
    }
}

}  // namespace

std::vector<Curve> without_repeats(const std::vector<Curve>& curves, std::size_t& repeated)
{
    using Key = std::array<std::int64_t, 6>;
    std::map<Key, int> seen;
    std::vector<Curve> out;
    for (const Curve& curve : curves) {
        const auto rounded = [](Vec2d p) {
            return std::array<std::int64_t, 2>{std::llround(p.x / kRepeated),
                                               std::llround(p.y / kRepeated)};
        };
        auto a = rounded(in_plan(curve.points.front()));
        auto b = rounded(in_plan(curve.points.back()));
        if (b < a) {
            std::swap(a, b);
        }
        const auto middle =
            rounded(in_plan(point_at(curve, (curve.domain_begin() + curve.domain_end()) / 2)));
        if (seen[{a[0], a[1], b[0], b[1], middle[0], middle[1]}]++ == 0) {
            out.push_back(curve);
        } else {
            ++repeated;
        }
    }
    return out;
}

std::string repeats_text(const std::string& name, std::size_t repeated)
{
    return fmt::format("{}: {} drawn twice and taken once", name,
                       repeated == 1 ? "1 curve is" : fmt::format("{} curves are", repeated));
}

LoopNesting nest_loops(const std::vector<Curve>& curves, double join)
{
    LoopNesting nesting;
    nesting.curves = curves.size();
    std::vector<Chain> chains;
    for (Curve& curve : without_repeats(curves, nesting.repeated)) {
        chains.push_back({std::move(curve)});
    }
    chains = Joining{chains, kEndsMeet}.sort_into(nesting);
    if (join > kEndsMeet && !chains.empty()) {
        chains = Joining{chains, join}.sort_into(nesting);
    }
    for (const Chain& chain : chains) {
        nesting.open.push_back(open_chain(chain));
    }
    std::stable_sort(nesting.loops.begin(), nesting.loops.end(),
                     [](const ClosedLoop& a, const ClosedLoop& b) { return a.area > b.area; });
    nest(nesting.loops);
    find_crossings(nesting);
    measure_gaps(nesting.open);
    return nesting;
}

}  // namespace cusp::import
