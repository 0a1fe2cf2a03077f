// Edges are halved until the clearance at both ends decides everything between.
#include "host_tools/cam/adaptive_isocurve/rest_regions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cusp::adaptive_isocurve {

using clearing::LayerRun;
using offset::Edge;

namespace {

constexpr double kShortestPart = 4e-3;      // mm: shorter undecided parts count as stock
constexpr double kShortGap = 2.0;           // radii: shorter than a retract and an entry
constexpr std::size_t kMostOrdered = 2000;  // more runs keep their order

struct Part {
    Edge edge;
    bool done;
};

class Sorting {
public:
    Sorting(const std::vector<ClearedPlaces>& before, std::vector<Part>& out)
        : before_{before}, out_{out}
    {
    }

    void add(const Edge& edge)
    {
        const double way = length(edge);
        bool is_stock = true;
        for (const ClearedPlaces& by : before_) {
            const double begin = by.region->clearance(edge.start) + by.rest_offset;
            const double end = by.region->clearance(edge.end) + by.rest_offset;
            if (begin >= 0 && end >= 0 && begin + end >= way) {
                out_.push_back({edge, true});
                return;
            }
            is_stock = is_stock && begin < 0 && end < 0 && begin + end <= -way;
        }
        if (is_stock || way < kShortestPart) {
            out_.push_back({edge, false});
            return;
        }
        const Vec2d middle = point_on(edge, 0.5);
        add(between(edge, edge.start, middle));
        add(between(edge, middle, edge.end));
    }

private:
    const std::vector<ClearedPlaces>& before_;
    std::vector<Part>& out_;
};

void keep_short_gaps(std::vector<Part>& parts, double longest)
{
    for (std::size_t i = 0; i < parts.size();) {
        std::size_t end = i;
        double gap = 0;
        for (; end < parts.size() && parts[end].done; ++end) {
            gap += length(parts[end].edge);
        }
        if (i > 0 && end < parts.size() && gap < longest) {
            std::for_each(parts.begin() + static_cast<std::ptrdiff_t>(i),
                          parts.begin() + static_cast<std::ptrdiff_t>(end),
                          [](Part& part) { part.done = false; });
        }
        i = std::max(end, i + 1);
    }
}

// True if two parts of a halved edge can be joined again.
bool continues(const Edge& last, const Edge& next)
{
    if (last.turn != next.turn) {
        return false;
    }
    if (last.turn != 0) {
        constexpr double kMostSweep = 3.0;  // radians: an arc is less than half a turn
        return norm(last.centre - next.centre) == 0 && sweep(last) + sweep(next) < kMostSweep;
    }
    constexpr double kStraight = 1e-9;
    const Vec2d a = last.end - last.start;
    const Vec2d b = next.end - next.start;
    return std::abs(cross(a, b)) <= kStraight * norm(a) * norm(b) && dot(a, b) > 0;
}

void append(std::vector<Edge>& edges, const Edge& next)
{
    if (!edges.empty() && continues(edges.back(), next)) {
        edges.back().end = next.end;
    } else {
        edges.push_back(next);
    }
}

void add_parts(const LayerRun& run, const std::vector<Part>& parts, std::vector<LayerRun>& out)
{
    const std::size_t first = out.size();
    LayerRun part;
    bool done_before = run.starts_in_cleared_stock;
    for (const Part& next : parts) {
        if (!next.done) {
            if (part.edges.empty()) {
                part.starts_in_cleared_stock = done_before;
            }
            append(part.edges, next.edge);
        } else if (!part.edges.empty()) {
            out.push_back(std::exchange(part, {}));
        }
        done_before = next.done;
    }
    if (part.edges.empty()) {
        return;
    }
    // Parts on both sides of a closed run's seam are one.
    const bool closed = norm(run.edges.front().start - run.edges.back().end) < 1e-9;
    if (closed && out.size() > first && !parts.front().done) {
        std::vector<Edge>& begin = out[first].edges;
        part.edges.insert(part.edges.end(), begin.begin(), begin.end());
        out[first] = std::move(part);
        return;
    }
    out.push_back(std::move(part));
}

void put_in_near_order(std::vector<LayerRun>& runs)
{
    if (runs.size() > kMostOrdered) {
        return;
    }
    for (std::size_t done = 1; done < runs.size(); ++done) {
        const Vec2d here = runs[done - 1].edges.back().end;
        const auto next = std::min_element(runs.begin() + static_cast<std::ptrdiff_t>(done),
                                           runs.end(), [&](const LayerRun& a, const LayerRun& b) {
                                               return norm(a.edges.front().start - here) <
                                                      norm(b.edges.front().start - here);
                                           });
        std::swap(runs[done], *next);
    }
}

}  // namespace

std::vector<LayerRun> rest_regions(const std::vector<LayerRun>& runs,
                                   double radius,
                                   const std::vector<ClearedPlaces>& before)
{
    std::vector<LayerRun> out;
    std::vector<Part> parts;
    for (const LayerRun& run : runs) {
        parts.clear();
        Sorting sorting{before, parts};
        for (const Edge& edge : run.edges) {
            sorting.add(edge);
        }
        keep_short_gaps(parts, kShortGap * radius);
        add_parts(run, parts, out);
    }
    put_in_near_order(out);
    return out;
}

}  // namespace cusp::adaptive_isocurve
