// Partial loops leave the loop outside them at a right angle, where walls only get farther away.
#include "host_tools/cam/clearing/partial_loops.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::clearing {

using job::CutDirection;
using offset::Contour;
using offset::distance;
using offset::Edge;
using offset::EdgeTree;
using offset::left_normal;
using offset::length;
using offset::line_edge;
using offset::RegionOffset;
using offset::reversed;

namespace {

// Consecutive parts of a closed loop.
struct Stretch {
    std::vector<Edge> edges;
};

class StretchSearch {
public:
    StretchSearch(const EdgeTree& feet, double depth, double margin)
        : feet_{feet}, depth_{depth}, margin_{margin}
    {
    }

    // The whole loop if all of it is wanted.
    std::vector<Stretch> on(const Contour& loop) const
    {
        std::vector<Stretch> found;
        bool open = false;
        for (const Edge& edge : loop) {
            const int n = 1 + static_cast<int>(length(edge) / (0.5 * margin_));
            Vec2d from = edge.start;
            bool wanted = is_wanted(edge, 0.0);
            for (int i = 1; i <= n; ++i) {
                const bool next = is_wanted(edge, static_cast<double>(i) / n);
                const Vec2d to = i < n ? point_on(edge, static_cast<double>(i) / n) : edge.end;
                const bool on = wanted || next;
                if (on && distance(from, to) > kShortest) {
                    if (!open) {
                        found.emplace_back();
                    }
                    append(found.back(), edge, from, to);
                }
                open = on;
                wanted = next;
                from = to;
            }
        }
        join_ends(found, open);
        return found;
    }

private:
    static constexpr double kShortest = 1e-6;  // mm

    bool is_wanted(const Edge& edge, double share) const
    {
        const Vec2d at = point_on(edge, share);
        const Vec2d foot = at - left_normal(tangent_on(edge, share)) * depth_;
        return feet_.any_nearer(foot, margin_) || feet_.any_nearer(at, margin_);
    }

    static void append(Stretch& stretch, const Edge& edge, Vec2d from, Vec2d to)
    {
        if (!stretch.edges.empty()) {
            Edge& last = stretch.edges.back();
            const bool same =
                last.turn == edge.turn && distance(last.end, from) < kShortest &&
                distance(last.centre, edge.centre) < kShortest &&
                (edge.turn != 0 || dot(tangent_at_end(last), tangent_at_start(edge)) > 1.0 - 1e-12);
            if (same) {
                last.end = to;
                return;
            }
        }
        Edge part = between(edge, from, to);
        stretch.edges.push_back(part);
    }

    static void join_ends(std::vector<Stretch>& found, bool open)
    {
        if (!open || found.size() < 2 ||
            distance(found.back().edges.back().end, found.front().edges.front().start) >
                kShortest) {
            return;
        }
        std::vector<Edge>& first = found.front().edges;
        std::vector<Edge>& last = found.back().edges;
        last.insert(last.end(), first.begin(), first.end());
        found.front() = std::move(found.back());
        found.pop_back();
    }

    const EdgeTree& feet_;
    double depth_;
    double margin_;
};

// A detour at a share of an edge of a pass.
struct Detour {
    std::size_t edge;
    double way;  // mm from the edge's start
    Vec2d foot;
    std::vector<Edge> path;
};

std::vector<Edge> there_and_back(const PartialLoop& loop, const Contour& path, Vec2d foot)
{
    std::vector<Edge> result{line_edge(foot, path.front().start)};
    result.insert(result.end(), path.begin(), path.end());
    if (!loop.whole) {
        const Contour back = reversed(path);
        result.insert(result.end(), back.begin(), back.end());
    }
    result.push_back(line_edge(path.front().start, foot));
    return result;
}

void put_in(Contour& pass, std::vector<Detour> detours)
{
    constexpr double kShortest = 1e-4;  // mm
    std::sort(detours.begin(), detours.end(), [](const Detour& a, const Detour& b) {
        return a.edge != b.edge ? a.edge < b.edge : a.way < b.way;
    });
    Contour result;
    auto next = detours.begin();
    for (std::size_t e = 0; e < pass.size(); ++e) {
        Vec2d from = pass[e].start;
        for (; next != detours.end() && next->edge == e; ++next) {
            const Vec2d foot = distance(from, next->foot) < kShortest ? from : next->foot;
            if (distance(from, foot) >= kShortest) {
                result.push_back(between(pass[e], from, foot));
            }
            next->path.front().start = foot;
            next->path.back().end = foot;
            result.insert(result.end(), next->path.begin(), next->path.end());
            from = foot;
        }
        if (distance(from, pass[e].end) > 0.0) {
            result.push_back(between(pass[e], from, pass[e].end));
        }
    }
    pass = std::move(result);
}

}  // namespace

std::vector<PartialLoop> loops_over(const std::vector<Edge>& feet,
                                    const RegionOffset& walls,
                                    double outer,
                                    double distance,
                                    double margin)
{
    constexpr double kMostOfLoop = 0.5;
    const EdgeTree tree{feet};
    const StretchSearch search{tree, distance - outer, margin};
    std::vector<PartialLoop> result;
    for (const Contour& loop : walls.at(distance).contours) {
        std::vector<Stretch> found = search.on(loop);
        double sum = 0.0;
        for (const Stretch& stretch : found) {
            sum += length(stretch.edges);
        }
        if (sum > kMostOfLoop * length(loop)) {
            result.push_back({loop, 0, distance - outer, true});
            continue;
        }
        for (Stretch& stretch : found) {
            result.push_back({std::move(stretch.edges), 0, distance - outer, false});
        }
    }
    return result;
}

double added_length(const std::vector<PartialLoop>& loops)
{
    double sum = 0.0;
    for (const PartialLoop& loop : loops) {
        sum += (loop.whole ? 1.0 : 2.0) * length(loop.path) + 2.0 * loop.depth;
    }
    return sum;
}

double length(const ClearedRegion& cleared)
{
    double sum = added_length(cleared.partial);
    for (const ClearingPass& pass : cleared.passes) {
        sum += length(pass.path);
    }
    return sum;
}

void put_in_partial_loops(ClearedRegion& cleared)
{
    std::vector<std::vector<Detour>> detours(cleared.passes.size());
    const bool turned = cleared.direction == CutDirection::kConventional;
    for (const PartialLoop& loop : cleared.partial) {
        const Contour path = turned ? reversed(loop.path) : loop.path;
        const double outward = turned ? loop.depth : -loop.depth;
        const Vec2d place =
            path.front().start + left_normal(tangent_at_start(path.front())) * outward;
        double least = kUnbounded;
        std::size_t best = 0;
        std::size_t at = 0;
        for (std::size_t i = 0; i < cleared.passes.size(); ++i) {
            const ClearingPass& pass = cleared.passes[i];
            for (std::size_t e = 0;
                 !pass.is_pencil && pass.ring == loop.ring && e < pass.path.size(); ++e) {
                const double apart = distance_to(pass.path[e], place);
                if (apart < least) {
                    least = apart;
                    best = i;
                    at = e;
                }
            }
        }
        const Edge& edge = cleared.passes[best].path[at];
        const Vec2d foot = nearest_on(edge, place);
        detours[best].push_back(
            {at, distance(edge.start, foot), foot, there_and_back(loop, path, foot)});
    }
    for (std::size_t i = 0; i < cleared.passes.size(); ++i) {
        if (!detours[i].empty()) {
            put_in(cleared.passes[i].path, std::move(detours[i]));
        }
    }
}

void end_with_partial_loops(ClearedRegion& cleared)
{
    ClearedRegion last = cleared;
    put_in_partial_loops(last);
    for (std::size_t i = 0; i < cleared.passes.size(); ++i) {
        ClearingPass& pass = cleared.passes[i];
        if (last.passes[i].path.size() > pass.path.size()) {
            pass.final_path = std::move(last.passes[i].path);
        }
    }
}

}  // namespace cusp::clearing
