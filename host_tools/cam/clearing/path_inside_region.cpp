// Stops where the straight line meets contours, and goes from stop to stop.
#include "host_tools/cam/clearing/path_inside_region.hpp"

#include <algorithm>

#include "host_tools/geometry/offset/edge_crossings.hpp"

namespace cusp::clearing {

using offset::Contour;
using offset::distance;
using offset::Edge;
using offset::kSamePoint;
using offset::length;
using offset::line_edge;
using offset::Region2d;
using offset::RegionPart;
using offset::reversed;

namespace {

// Places where the straight line meets a contour; its ends meet none.
struct Meeting {
    Vec2d at;
    std::size_t contour;
    std::size_t edge;
};

std::vector<Meeting> meetings(const Region2d& region, const Edge& way)
{
    std::vector<Meeting> found;
    for (std::size_t c = 0; c < region.contours.size(); ++c) {
        for (std::size_t e = 0; e < region.contours[c].size(); ++e) {
            for (const Vec2d p : crossings(way, region.contours[c][e], kSamePoint)) {
                found.push_back({p, c, e});
            }
        }
    }
    std::sort(found.begin(), found.end(), [&](const Meeting& a, const Meeting& b) {
        return distance(way.start, a.at) < distance(way.start, b.at);
    });
    return found;
}

void add_part(std::vector<Edge>& way, const Edge& edge, Vec2d from, Vec2d to)
{
    if (distance(from, to) > kSamePoint) {
        way.push_back(between(edge, from, to));
    }
}

// In the direction of the contour.
std::vector<Edge> onward(const Contour& contour, const Meeting& from, const Meeting& to)
{
    std::vector<Edge> way;
    const Edge& first = contour[from.edge];
    const bool on_one =
        from.edge == to.edge && distance(first.start, from.at) <= distance(first.start, to.at);
    add_part(way, first, from.at, on_one ? to.at : first.end);
    if (!on_one) {
        for (std::size_t e = (from.edge + 1) % contour.size(); e != to.edge;
             e = (e + 1) % contour.size()) {
            way.push_back(contour[e]);
        }
        add_part(way, contour[to.edge], contour[to.edge].start, to.at);
    }
    return way;
}

std::vector<Edge> shorter_way_round(const Contour& contour, const Meeting& from, const Meeting& to)
{
    std::vector<Edge> on = onward(contour, from, to);
    const std::vector<Edge> back = reversed(onward(contour, to, from));
    return length(back) < length(on) ? back : on;
}

// The part of the region that contains both points.
Region2d part_with(const Region2d& region, Vec2d a, Vec2d b)
{
    for (const RegionPart& part : connected_parts(region)) {
        Region2d whole{{region.contours[part.outer]}};
        for (const std::size_t hole : part.holes) {
            whole.contours.push_back(region.contours[hole]);
        }
        if (contains(whole, a) && contains(whole, b)) {
            return whole;
        }
    }
    return {};
}

}  // namespace

std::vector<Edge> path_inside_region(const Region2d& region, Vec2d from, Vec2d to)
{
    constexpr double kNotch = 1e-5;  // mm: counts as inside
    const Region2d part = part_with(region, from, to);
    std::vector<Edge> way;
    if (part.contours.empty() || distance(from, to) <= kSamePoint) {
        return way;
    }
    const Edge straight = line_edge(from, to);
    const std::size_t none = part.contours.size();
    std::vector<Meeting> stops = meetings(part, straight);
    stops.push_back({to, none, 0});
    Meeting last{from, none, 0};
    for (const Meeting& next : stops) {
        const Vec2d middle = (last.at + next.at) * 0.5;
        if (distance(last.at, next.at) < kNotch || contains(part, middle)) {
            add_part(way, straight, last.at, next.at);
        } else if (last.contour == next.contour && last.contour != none) {
            const std::vector<Edge> round =
                shorter_way_round(part.contours[next.contour], last, next);
            way.insert(way.end(), round.begin(), round.end());
        } else {
            return {};
        }
        last = next;
    }
    return way;
}

}  // namespace cusp::clearing
