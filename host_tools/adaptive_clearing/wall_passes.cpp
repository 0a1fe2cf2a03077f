// Stretches are found at stations along the contour, and begin and end a little before and behind
// the stock.
#include "host_tools/adaptive_clearing/wall_passes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "firmware/base/math.hpp"

namespace cusp::adaptive_clearing {

using offset::arc_edge;
using offset::between;
using offset::Contour;
using offset::Edge;
using offset::left_normal;
using offset::length;
using offset::point_on;
using offset::tangent_at_end;
using offset::tangent_at_start;
using offset::tangent_on;

namespace {

constexpr double kStations = 0.05;    // radii
constexpr double kBarelyOpen = 0.03;  // radians: less is no stock
constexpr double kBeyond = 0.1;       // radii before and behind the stock
constexpr double kJoined = 0.4;       // radii: nearer stretches are one
constexpr double kLeadAngle = kPi / 5;
constexpr double kShortest = 1e-6;  // mm

struct Stretch {
    double from;  // mm along the contour
    double to;    // may be over its length
};

// The part of the closed contour between two lengths along it.
std::vector<Edge> part_of(const Contour& contour, Stretch stretch)
{
    const double whole = length(contour);
    std::vector<Edge> part;
    double at = std::floor(stretch.from / whole) * whole;
    for (int turn = 0; turn < 4 && at < stretch.to; ++turn) {
        for (const Edge& edge : contour) {
            const double size = length(edge);
            const double from = std::max(0.0, stretch.from - at);
            const double to = std::min(size, stretch.to - at);
            if (to - from > kShortest) {
                part.push_back(
                    between(edge, point_on(edge, from / size), point_on(edge, to / size)));
            }
            at += size;
        }
    }
    return part;
}

bool is_clear(const WallSpace& space, Vec2d centre, double slack)
{
    return !space.walls.any_nearer(centre, space.wall_clearance - slack);
}

// A tangent arc from swept ground onto the start of the path; none where there is no room.
std::optional<Edge> lead_in(const Edge& first, const WallSpace& space)
{
    const double radius = space.swept.radius();
    const Vec2d t = tangent_at_start(first);
    const Vec2d n = left_normal(t);
    for (const double size : {0.4, 0.2, 0.1, 0.05}) {
        const double r = size * radius;
        const Vec2d centre = first.start + n * r;
        const Vec2d start = centre - (n * std::cos(kLeadAngle) + t * std::sin(kLeadAngle)) * r;
        const Edge arc = arc_edge(start, first.start, centre, 1);
        const bool clear = is_clear(space, start, 0.0) && is_clear(space, point_on(arc, 0.5), 1e-6);
        if (clear && space.swept.engagement(start, tangent_at_start(arc), -space.sliver,
                                            0.5 * kPi) < kBarelyOpen) {
            return arc;
        }
    }
    return std::nullopt;
}

std::optional<Edge> lead_out(const Edge& last, const WallSpace& space)
{
    const Vec2d t = tangent_at_end(last);
    const Vec2d n = left_normal(t);
    for (const double size : {0.4, 0.2, 0.1, 0.05}) {
        const double r = size * space.swept.radius();
        const Vec2d centre = last.end + n * r;
        const Vec2d end = centre - (n * std::cos(kLeadAngle) - t * std::sin(kLeadAngle)) * r;
        const Edge arc = arc_edge(last.end, end, centre, 1);
        if (is_clear(space, end, 0.0) && is_clear(space, point_on(arc, 0.5), 1e-6)) {
            return arc;
        }
    }
    return std::nullopt;
}

// Lengths along the contour between which stock is; in order.
std::vector<Stretch> stretches_of(const Contour& contour, const WallSpace& space)
{
    const double radius = space.swept.radius();
    std::vector<Stretch> found;
    double at = 0.0;
    for (const Edge& edge : contour) {
        const double size = length(edge);
        const int n = std::max(edge.turn != 0 ? 4 : 1,
                               static_cast<int>(std::ceil(size / (kStations * radius))));
        for (int i = 0; i < n; ++i) {
            const double share = (i + 0.5) / n;
            if (space.swept.engagement(point_on(edge, share), tangent_on(edge, share),
                                       -space.sliver) < kBarelyOpen) {
                continue;
            }
            const Stretch stock{at + size * i / n - kBeyond * radius,
                                at + size * (i + 1) / n + kBeyond * radius};
            if (!found.empty() && stock.from < found.back().to + kJoined * radius) {
                found.back().to = stock.to;
            } else {
                found.push_back(stock);
            }
        }
        at += size;
    }
    return found;
}

}  // namespace

std::vector<std::vector<Edge>> uncut_stretches(const Contour& contour, const WallSpace& space)
{
    const double radius = space.swept.radius();
    const double whole = length(contour);
    std::vector<Stretch> found = stretches_of(contour, space);
    if (found.size() > 1 && found.front().from + whole < found.back().to + kJoined * radius) {
        found.front().from = found.back().from - whole;
        found.pop_back();
    }
    std::vector<std::vector<Edge>> result;
    for (Stretch stretch : found) {
        if (stretch.to - stretch.from > whole - kJoined * radius) {
            // Starts in the middle of the longest edge.
            const auto longest = std::max_element(
                contour.begin(), contour.end(),
                [](const Edge& a, const Edge& b) { return length(a) < length(b); });
            double at = 0.5 * length(*longest);
            for (auto e = contour.begin(); e != longest; ++e) {
                at += length(*e);
            }
            stretch = {at, at + whole + kBeyond * radius};
        }
        if (stretch.from < 0.0) {
            stretch.from += whole;
            stretch.to += whole;
        }
        std::vector<Edge> path = part_of(contour, stretch);
        if (path.empty()) {
            continue;
        }
        if (const std::optional<Edge> lead = lead_in(path.front(), space)) {
            path.insert(path.begin(), *lead);
        }
        if (const std::optional<Edge> lead = lead_out(path.back(), space)) {
            path.push_back(*lead);
        }
        result.push_back(std::move(path));
    }
    return result;
}

}  // namespace cusp::adaptive_clearing
