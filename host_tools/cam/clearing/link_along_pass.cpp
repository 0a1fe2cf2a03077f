// Searches for the nearest place from the ends and middles of the edges of the next pass.
#include "host_tools/cam/clearing/link_along_pass.hpp"

#include <optional>

namespace cusp::clearing {

using offset::Contour;
using offset::distance;
using offset::Edge;
using offset::line_edge;
using offset::reversed;

namespace {

constexpr double kPoint = 1e-6;  // mm

struct Crossing {
    std::size_t edge{};  // of the pass before
    Vec2d from;          // on it
    Vec2d to;            // on the next
    double way{};        // mm, along the pass before, and across
    bool backward{};
};

// Otherwise a part of an arc could become the whole arc.
bool has_length(Vec2d from, Vec2d to) { return distance(from, to) >= kPoint; }

// The parts of the pass up to the place, or from its end back to it.
std::vector<Edge> part_of(const Contour& pass, const Crossing& crossing)
{
    const Edge& last = pass[crossing.edge];
    const auto at = pass.begin() + static_cast<std::ptrdiff_t>(crossing.edge);
    std::vector<Edge> part;
    if (crossing.backward) {
        if (has_length(crossing.from, last.end)) {
            part.push_back(between(last, crossing.from, last.end));
        }
        part.insert(part.end(), at + 1, pass.end());
        return reversed(part);
    }
    part.assign(pass.begin(), at);
    if (has_length(last.start, crossing.from)) {
        part.push_back(between(last, last.start, crossing.from));
    }
    return part;
}

}  // namespace

std::vector<Edge> link_along_pass(const Contour& before, const Contour& next, double farthest)
{
    std::vector<double> ways{0.0};
    for (const Edge& edge : before) {
        ways.push_back(ways.back() + length(edge));
    }
    std::optional<Crossing> best;
    const auto look = [&](Vec2d to) {
        for (std::size_t i = 0; i < before.size(); ++i) {
            const Vec2d from = nearest_on(before[i], to);
            const double over = distance(from, to);
            if (over > farthest) {
                continue;
            }
            const bool inside = has_length(before[i].start, from);
            const double forward =
                ways[i] + (inside ? length(between(before[i], before[i].start, from)) : 0.0);
            const bool backward = ways.back() - forward < forward;
            const double way = over + (backward ? ways.back() - forward : forward);
            if (!best || way < best->way) {
                best = Crossing{i, from, to, way, backward};
            }
        }
    };
    for (const Edge& edge : next) {
        look(edge.start);
        look(point_on(edge, 0.5));
    }
    if (!best) {
        return {};
    }
    std::vector<Edge> link = part_of(before, *best);
    link.push_back(line_edge(best->from, best->to));
    return link;
}

}  // namespace cusp::clearing
