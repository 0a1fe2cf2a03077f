// Paths that are loops by themselves stay so; loose pieces are joined where they meet, and what is open
// then, across gaps up to the tolerance.
#include "host_tools/job/import/loop_nesting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>
#include <tuple>

#include "host_tools/job/import/path_chains.hpp"
#include "host_tools/job/job/loop_shape.hpp"

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

constexpr double kOutline = 1e-3;  // mm, of chords
// mm: loops that cross no deeper touch, as chords of an arc of two loops do.
constexpr double kTouching = 2 * kOutline;
// Places of the last digit that ends are apart where both are rounded.
constexpr double kPlacesApart = 2;
constexpr double kRepeated = 1e-4;          // mm: distance below which curves are duplicates
constexpr std::size_t kMostSides = 200000;  // limit of the search for crossings

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

Measures measures_of(const CurveChain& chain)
{
    const Vec2d origin = in_plan(chain.front().points.front());
    Measures sum;
    for (const Curve& curve : chain) {
        const Measures one = measures_of(curve, origin);
        sum.length += one.length;
        sum.area += one.area;
    }
    return sum;
}

void add_loop(const CurveChain& chain, const Measures& measures, LoopNesting& nesting)
{
    nesting.loops.push_back({chain, loop_polyline(chain, kOutline), measures.length,
                             std::abs(measures.area), measures.area > 0, -1, 0, std::nullopt});
}

void add_joined(ChainResult joined, LoopNesting& nesting)
{
    for (const CurveChain& chain : joined.closed) {
        add_loop(chain, measures_of(chain), nesting);
    }
    nesting.bridged += joined.bridged;
    nesting.widest_gap = std::max(nesting.widest_gap, joined.widest_gap);
}

// Place of a curve, the same either way round.
using Place = std::array<std::int64_t, 6>;

Place place_of(const Curve& curve)
{
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
    return {a[0], a[1], b[0], b[1], middle[0], middle[1]};
}

// Sorts paths into loops and loose pieces, and leaves out what is drawn twice.
class Sorting {
public:
    Sorting(const std::vector<DrawingPath>& paths, LoopNesting& nesting) : nesting_{nesting}
    {
        for (const DrawingPath& path : paths) {
            if (!path.curves.empty() && !take_loop(path)) {
                take_pieces(path);
            }
        }
    }

    const std::vector<CurveChain>& pieces() const { return pieces_; }

    // Without the chains that lie on loops, edge by edge: they are drawn over them.
    std::vector<CurveChain> without_repeats_of_loops(const std::vector<CurveChain>& chains)
    {
        std::vector<CurveChain> kept;
        for (const CurveChain& chain : chains) {
            if (std::all_of(chain.begin(), chain.end(), [&](const Curve& curve) {
                    return on_loops_.count(place_of(curve)) > 0;
                })) {
                nesting_.repeated += chain.size();
            } else {
                kept.push_back(chain);
            }
        }
        return kept;
    }

private:
    // Closed loops may have edges in common, but not all of them.
    bool take_loop(const DrawingPath& path)
    {
        const Vec2d begin = in_plan(path.curves.front().points.front());
        const Vec2d end = in_plan(path.curves.back().points.back());
        if (norm(end - begin) > kEndsMeet) {
            return false;
        }
        const Measures measures = measures_of(path.curves);
        constexpr double kThin = 1e-9;  // of the length, squared: drawn there and back
        if (!(measures.length > 2 * kEndsMeet) ||
            !(std::abs(measures.area) > kThin * measures.length * measures.length)) {
            return false;
        }
        std::vector<Place> places;
        for (const Curve& curve : path.curves) {
            places.push_back(place_of(curve));
        }
        on_loops_.insert(places.begin(), places.end());
        std::sort(places.begin(), places.end());
        if (loops_.insert(places).second) {
            add_loop(path.curves, measures, nesting_);
        } else {
            nesting_.repeated += path.curves.size();
        }
        return true;
    }

    void take_pieces(const DrawingPath& path)
    {
        std::vector<Curve> kept;
        for (const Curve& curve : path.curves) {
            if (loose_.insert(place_of(curve)).second) {
                kept.push_back(curve);
            }
        }
        if (kept.size() == path.curves.size()) {
            pieces_.push_back(std::move(kept));
            return;
        }
        nesting_.repeated += path.curves.size() - kept.size();
        for (Curve& curve : kept) {
            pieces_.push_back({std::move(curve)});
        }
    }

    LoopNesting& nesting_;
    std::vector<CurveChain> pieces_;
    std::set<Place> loose_, on_loops_;
    std::set<std::vector<Place>> loops_;
};

OpenChain open_chain(const CurveChain& chain)
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
    return {outline, chain.size(), length, begin, end, 0, begin, end, chain};
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
    if (sides > kMostSides || !(nesting.crossing = crossing_of(outlines, kTouching))) {
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
    std::set<Place> seen;
    std::vector<Curve> out;
    for (const Curve& curve : curves) {
        if (seen.insert(place_of(curve)).second) {
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

double join_limit(double resolution)
{
    return std::clamp(kPlacesApart * resolution, kJoinTolerance, kWidestJoin);
}

LoopNesting nest_loops(const std::vector<DrawingPath>& paths, double join)
{
    LoopNesting nesting;
    for (const DrawingPath& path : paths) {
        nesting.curves += path.curves.size();
    }
    Sorting sorted{paths, nesting};
    ChainResult met = join_chains(sorted.pieces(), kEndsMeet, kEndsMeet);
    std::vector<CurveChain> open = sorted.without_repeats_of_loops(met.open);
    if (met.junction) {
        nesting.junction = met.junction->at;
        nesting.junction_ends = met.junction->ends;
    }
    add_joined(std::move(met), nesting);
    if (join > kEndsMeet && !open.empty()) {
        ChainResult bridged = join_chains(open, join, kEndsMeet);
        open = std::move(bridged.open);
        add_joined(std::move(bridged), nesting);
    }
    for (const CurveChain& chain : open) {
        nesting.open.push_back(open_chain(chain));
    }
    std::stable_sort(nesting.loops.begin(), nesting.loops.end(),
                     [](const ClosedLoop& a, const ClosedLoop& b) { return a.area > b.area; });
    nest(nesting.loops);
    find_crossings(nesting);
    measure_gaps(nesting.open);
    return nesting;
}

LoopNesting nest_loops(const std::vector<Curve>& curves, double join)
{
    std::vector<DrawingPath> paths;
    for (const Curve& curve : curves) {
        paths.push_back({{curve}, false});
    }
    return nest_loops(paths, join);
}

}  // namespace cusp::import
