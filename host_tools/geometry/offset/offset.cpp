// Cuts the raw offset at its crossings, keeps the runs to which no source edge is nearer than the
// distance, and joins them.
#include "host_tools/geometry/offset/offset.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <optional>

#include "firmware/base/math.hpp"
#include "host_tools/geometry/offset/edge_crossings.hpp"
#include "host_tools/geometry/offset/edge_reach.hpp"
#include "host_tools/geometry/offset/edge_runs.hpp"
#include "host_tools/geometry/offset/piece_trim.hpp"
#include "host_tools/geometry/offset/raw_offset.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"

namespace cusp::offset {

namespace {

constexpr double kSlack = 1e-9;       // a crossing may lie this far beyond an edge's end
constexpr double kNearer = 2e-8;      // a run this much too near is still kept
constexpr double kLostRun = 1e-3;     // mm: rounding leaves no open run as long at the distance
constexpr std::size_t kCrowded = 25;  // pairs a piece beside each other: trimming them is cheaper

struct Cut {
    std::uint32_t piece;
    double along;  // share of the chord
    Vec2d point;
};

void cut_pair(const std::vector<RawPiece>& pieces,
              const std::vector<std::uint32_t>& next,
              std::uint32_t i,
              std::uint32_t j,
              std::vector<Cut>& cuts)
{
    const Edge& a = pieces[i].edge;
    const Edge& b = pieces[j].edge;
    for (const Vec2d p : crossings(a, b, kSlack)) {
        const bool shared =
            (pieces[i].joined && next[i] == j && distance(p, a.end) < kSameVertex) ||
            (pieces[j].joined && next[j] == i && distance(p, b.end) < kSameVertex);
        if (!shared) {
            cuts.push_back({i, share_of_chord(a, p), p});
            cuts.push_back({j, share_of_chord(b, p), p});
        }
    }
}

std::vector<std::uint32_t> successors(const std::vector<RawPiece>& pieces)
{
    std::vector<std::uint32_t> next(pieces.size());
    std::uint32_t first = 0;
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
        next[i] = pieces[i].last ? first : i + 1;
        if (pieces[i].last) {
            first = i + 1;
        }
    }
    return next;
}

// All crossings of two pieces, by a sweep along x; none where more than `max_pairs` pairs of boxes
// overlap in x.
std::optional<std::vector<Cut>> find_cuts(const std::vector<RawPiece>& pieces,
                                          std::size_t max_pairs)
{
    const std::vector<std::uint32_t> next = successors(pieces);
    struct Entry {
        double x0;
        std::uint32_t piece;
    };
    std::vector<Entry> entries(pieces.size());
    std::vector<Box2d> boxes(pieces.size());
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
        const Box2d box = box_of(pieces[i].edge);
        boxes[i] = {box.x0 - kSlack, box.y0 - kSlack, box.x1 + kSlack, box.y1 + kSlack};
        entries[i] = {boxes[i].x0, i};
    }
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return a.x0 < b.x0; });
    std::vector<Cut> cuts;
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const Box2d& box = boxes[entries[i].piece];
        for (std::size_t j = i + 1; j < entries.size() && entries[j].x0 <= box.x1; ++j) {
            if (++pairs > max_pairs) {
                return std::nullopt;
            }
            const Box2d& other = boxes[entries[j].piece];
            if (other.y0 <= box.y1 && box.y0 <= other.y1) {
                cut_pair(pieces, next, entries[i].piece, entries[j].piece, cuts);
            }
        }
    }
    std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) {
        return a.piece != b.piece ? a.piece < b.piece : a.along < b.along;
    });
    return cuts;
}

// Divides the raw contours into runs at crossings and gaps.
class RunBuilder {
public:
    explicit RunBuilder(std::vector<Run>& runs) : runs_{runs} {}

    void begin_contour(bool joined)
    {
        joined_ = joined;
        contour_begin_ = runs_.size();
        run_ = {{}, {}, false, !joined};
        cut_ = false;
    }
    void add(const Edge& edge, std::uint32_t origin)
    {
        if (distance(edge.start, edge.end) > kShortestPiece) {
            run_.edges.push_back(edge);
            run_.origins.push_back(origin);
        }
    }
    void end_run(bool at_gap)
    {
        run_.open_end = run_.open_end || at_gap;
        runs_.push_back(std::move(run_));
        run_ = {{}, {}, false, at_gap};
        cut_ = true;
    }
    void end_contour()
    {
        if (!joined_) {
            end_run(true);
            return;
        }
        if (!cut_) {
            run_.closed = true;
            runs_.push_back(std::move(run_));
            return;
        }
        // The contour's last run continues in its first.
        Run& head = runs_[contour_begin_];
        head.open_end = head.open_end || run_.open_end;
        head.edges.insert(head.edges.begin(), run_.edges.begin(), run_.edges.end());
        head.origins.insert(head.origins.end(), run_.origins.begin(), run_.origins.end());
    }

private:
    std::vector<Run>& runs_;
    Run run_;
    std::size_t contour_begin_{};
    bool joined_{};
    bool cut_{};
};

// For each contour of the raw offset, whether its last piece joins its first.
std::vector<bool> closing_joints(const std::vector<RawPiece>& pieces)
{
    std::vector<bool> joints;
    for (const RawPiece& piece : pieces) {
        if (piece.last) {
            joints.push_back(piece.joined);
        }
    }
    return joints;
}

std::vector<Run> split_into_runs(const std::vector<RawPiece>& pieces, const std::vector<Cut>& cuts)
{
    std::vector<Run> runs;
    RunBuilder builder{runs};
    const std::vector<bool> joints = closing_joints(pieces);
    std::size_t contour = 0;
    std::size_t cut = 0;
    bool first = true;
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
        if (first) {
            builder.begin_contour(joints[contour++]);
        }
        const Edge& edge = pieces[i].edge;
        Vec2d from = edge.start;
        for (; cut < cuts.size() && cuts[cut].piece == i; ++cut) {
            builder.add(between(edge, from, cuts[cut].point), pieces[i].origin);
            builder.end_run(false);
            from = cuts[cut].point;
        }
        builder.add(between(edge, from, edge.end), pieces[i].origin);
        first = pieces[i].last;
        if (pieces[i].last) {
            builder.end_contour();
        } else if (!pieces[i].joined) {
            builder.end_run(true);
        }
    }
    return runs;
}

Vec2d middle_of(const Run& run)
{
    const auto longest =
        std::max_element(run.edges.begin(), run.edges.end(), [](const Edge& a, const Edge& b) {
            const Vec2d u = a.end - a.start;
            const Vec2d v = b.end - b.start;
            return dot(u, u) < dot(v, v);
        });
    const Vec2d chord_middle = 0.5 * (longest->start + longest->end);
    if (longest->turn == 0) {
        return chord_middle;
    }
    return longest->centre + unit(chord_middle - longest->centre) * longest->radius;
}

double length_of(const Run& run)
{
    double sum = 0;
    for (const Edge& edge : run.edges) {
        sum += length(edge);
    }
    return sum;
}

// Fast test by chords: the segment of an arc is no larger than the half disc over its chord.
bool encloses_nothing(const Contour& contour)
{
    constexpr double kHalfPi = 0.5 * kPi;
    double twice = 0.0;
    double segments = 0.0;
    double chords = 0.0;
    for (const Edge& edge : contour) {
        const Vec2d chord = edge.end - edge.start;
        twice += cross(edge.start - contour.front().start, chord);
        segments += edge.turn == 0 ? 0.0 : 0.25 * kHalfPi * dot(chord, chord);
        chords += norm(chord);
    }
    if (0.5 * std::abs(twice) - segments > 1e-6 * kHalfPi * chords) {
        return false;
    }
    return std::abs(area(contour)) <= 1e-6 * length(contour);
}

// Source contours that touch or share edges give coincident runs, and runs on the wrong side to
// which no other edge is nearer. This removes both; for other contours it has no effect.
void remove_wrong_and_double(const EdgeTree& source, bool unbounded, std::vector<Run>& runs)
{
    std::vector<Vec2d> middles;  // by x
    const auto left_of = [](Vec2d a, double x) {
        return a.x < x;
    };
    const auto wrong_or_double = [&](const Run& run) {
        const Vec2d middle = middle_of(run);
        auto at = std::lower_bound(middles.begin(), middles.end(), middle.x - kSameVertex, left_of);
        bool seen = false;
        for (; at != middles.end() && at->x < middle.x + kSameVertex; ++at) {
            seen = seen || distance(*at, middle) < kSameVertex;
        }
        middles.insert(std::lower_bound(middles.begin(), middles.end(), middle.x, left_of), middle);
        return seen || source.surrounds(middle) == unbounded;
    };
    runs.erase(std::remove_if(runs.begin(), runs.end(), wrong_or_double), runs.end());
}

// True if two contours have a point in common.
bool contours_touch(const Region2d& source, const EdgeTree& tree)
{
    std::vector<std::size_t> contour_of;
    std::vector<const Edge*> edges;
    for (std::size_t c = 0; c < source.contours.size(); ++c) {
        for (const Edge& edge : source.contours[c]) {
            contour_of.push_back(c);
            edges.push_back(&edge);
        }
    }
    bool touch = false;
    for (std::size_t i = 0; i < edges.size() && !touch; ++i) {
        tree.visit_meeting(box_of(*edges[i]), [&](std::uint32_t j) {
            touch = touch || (contour_of[i] < contour_of[j] &&
                              !crossings(*edges[i], *edges[j], kSameVertex).empty());
        });
    }
    return touch;
}

struct KeptRuns {
    std::vector<Run> runs;
    std::vector<std::uint32_t> gone;  // origins of pieces of which nothing is left
    bool complete;                    // no run that belongs to the offset misses its crossing
};

KeptRuns kept_runs(const Region2d& source,
                   const EdgeTree& tree,
                   const std::vector<double>& gone,
                   double distance)
{
    std::vector<RawPiece> pieces = living_pieces(raw_offset(source, distance), gone, distance);
    std::vector<std::uint32_t> looked_at;
    for (const RawPiece& piece : pieces) {
        // A run may skip a whole short piece.
        if (cusp::offset::distance(piece.edge.start, piece.edge.end) > kSameVertex) {
            looked_at.push_back(piece.origin);
        }
    }
    auto cuts = find_cuts(pieces, kCrowded * pieces.size());
    if (!cuts) {
        pieces = trimmed(pieces, tree, distance);
        cuts = find_cuts(pieces, SIZE_MAX);
    }
    KeptRuns kept{split_into_runs(pieces, *cuts), {}, true};
    // A point too near to one run is usually too near to the next one.
    std::optional<Vec2d> nearer;
    const auto too_near = [&](const Run& run) {
        if (run.edges.empty()) {
            return true;
        }
        const double reach = distance - kNearer;
        const Vec2d middle = middle_of(run);
        if (!nearer || cusp::offset::distance(middle, *nearer) >= reach) {
            nearer = tree.some_nearer(middle, reach);
        }
        if (run.open_end && !nearer && length_of(run) > kLostRun) {
            kept.complete = false;
        }
        return run.open_end || nearer.has_value();
    };
    kept.runs.erase(std::remove_if(kept.runs.begin(), kept.runs.end(), too_near), kept.runs.end());
    std::vector<bool> lives(gone.size(), false);
    for (const Run& run : kept.runs) {
        for (const std::uint32_t origin : run.origins) {
            lives[origin] = true;
        }
    }
    std::copy_if(looked_at.begin(), looked_at.end(), std::back_inserter(kept.gone),
                 [&](std::uint32_t origin) { return !lives[origin]; });
    return kept;
}

std::optional<Region2d> offset_once(const Region2d& source,
                                    const EdgeTree& tree,
                                    double distance,
                                    bool touching,
                                    bool unbounded,
                                    std::vector<double>& gone)
{
    KeptRuns kept = kept_runs(source, tree, gone, distance);
    if (!kept.complete) {
        return std::nullopt;
    }
    if (touching) {
        remove_wrong_and_double(tree, unbounded, kept.runs);
    }
    std::optional<Region2d> region = joined(kept.runs);
    if (region) {
        auto& contours = region->contours;
        contours.erase(std::remove_if(contours.begin(), contours.end(), encloses_nothing),
                       contours.end());
        for (const std::uint32_t origin : kept.gone) {
            gone[origin] = std::min(gone[origin], distance);
        }
    }
    return region;
}

}  // namespace

RegionOffset::RegionOffset(Region2d source)
    : source_{std::move(source)},
      tree_{edges_of(source_)},
      touching_{contours_touch(source_, tree_)},
      unbounded_{area(source_) < 0.0},
      gone_(kOrigins * tree_.size(), kUnbounded)
{
}

Region2d RegionOffset::at(double distance) const
{
    // If rounding at a common point of several pieces defeats the joining, a distance nearby is
    // used. The steps are below the promised accuracy of 1e-6 mm.
    constexpr double kSteps[] = {0.0, 1e-8, -1e-8, 3e-8, 1e-7, -1e-7, 3e-7, -3e-7, 8e-7, -8e-7};
    for (const double step : kSteps) {
        if (auto region =
                offset_once(source_, tree_, distance + step, touching_, unbounded_, gone_)) {
            return *region;
        }
    }
    const Region2d too_near = edge_reach(source_, distance);
    return unbounded_ ? reversed(united(reversed(source_), too_near)) : without(source_, too_near);
}

double RegionOffset::clearance(Vec2d point) const
{
    const double apart = tree_.nearest(point, kUnbounded);
    return contains(point) ? apart : -apart;
}

Region2d reversed(const Region2d& region)
{
    Region2d result;
    for (const Contour& contour : region.contours) {
        result.contours.push_back(reversed(contour));
    }
    return result;
}

Region2d grown(const Region2d& region, double distance)
{
    return reversed(RegionOffset{reversed(region)}.at(distance));
}

}  // namespace cusp::offset
