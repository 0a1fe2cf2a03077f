// Stretches are found at stations along the contour, and begin and end a little before and behind
// the stock.
#include "host_tools/cam/adaptive_clearing/wall_passes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/adaptive_clearing/wall_budget.hpp"
#include "host_tools/cam/clearing/clear_path.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::adaptive_clearing {

using clearing::is_path_clear;
using offset::arc_edge;
using offset::between;
using offset::Box2d;
using offset::box_of;
using offset::Contour;
using offset::Edge;
using offset::left_normal;
using offset::length;
using offset::meet;
using offset::point_on;
using offset::tangent_at_end;
using offset::tangent_at_start;
using offset::tangent_on;

namespace {

constexpr double kStations = 0.05;  // radii
constexpr double kBeyond = 0.1;     // radii before and behind the stock
constexpr double kJoined = 0.4;     // radii: nearer stretches are one
constexpr double kLeadAngle = kPi / 5;
constexpr double kShortest = 1e-6;   // mm
constexpr double kOnContour = 5e-5;  // mm: a lead ends on the contour, which is that exact

bool is_in_box(const Box2d& box, Vec2d p)
{
    return p.x >= box.x0 && p.x <= box.x1 && p.y >= box.y0 && p.y <= box.y1;
}

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

bool is_corner(const Edge& before, const Edge& after)
{
    constexpr double kTangent = 0.99;
    return dot(tangent_at_end(before), tangent_at_start(after)) < kTangent;
}

// The tool can not be there before a pass.
bool is_in_stock(Vec2d place, const WallSpace& space)
{
    constexpr double kSunk = 0.005;  // radii: less stays beside a path that was cut
    return space.swept.engagement(place, {1.0, 0.0}, -kSunk * space.swept.radius(), 0.5 * kPi) >
           0.0;
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
        const Vec2d start =
            centre - (n * elementary::cos(kLeadAngle) + t * elementary::sin(kLeadAngle)) * r;
        const Edge arc = arc_edge(start, first.start, centre, 1);
        if (is_path_clear(space.walls, arc, space.wall_clearance - kOnContour) &&
            space.swept.engagement(start, tangent_at_start(arc), -space.sliver, 0.5 * kPi) <
                barely_open(space.sliver, radius)) {
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
        const Vec2d end =
            centre - (n * elementary::cos(kLeadAngle) - t * elementary::sin(kLeadAngle)) * r;
        const Edge arc = arc_edge(last.end, end, centre, 1);
        if (is_path_clear(space.walls, arc, space.wall_clearance - kOnContour)) {
            return arc;
        }
    }
    return std::nullopt;
}

// Lengths along the contour between which stock is, in order, none over a piece where the
// engagement would be over the limit.
class StretchFinder {
public:
    StretchFinder(const Contour& contour, const WallSpace& space)
        : contour_{contour},
          space_{space},
          barely_open_{barely_open(space.sliver, space.swept.radius())}
    {
    }

    std::vector<Stretch> find()
    {
        const double pitch = kStations * space_.swept.radius();
        double at = 0.0;
        for (std::size_t k = 0; k < contour_.size(); ++k) {
            const Edge& edge = contour_[k];
            const Edge& next = contour_[(k + 1) % contour_.size()];
            const double size = length(edge);
            if (!meet(box_of(edge), space_.spot)) {
                at += size;
                continue;
            }
            const int n =
                std::max(edge.turn != 0 ? 4 : 1, static_cast<int>(std::ceil(size / pitch)));
            for (int i = 0; i < n; ++i) {
                // The stock in a sharp corner is met only at its very end.
                if (has_stock(edge, (i + 0.5) / n) ||
                    (i + 1 == n && is_corner(edge, next) && has_stock(edge, 1.0))) {
                    add(edge, i, n, at);
                }
            }
            at += size;
        }
        join_ends(at);
        return std::move(found_);
    }

    bool has_barrier() const { return barrier_end_ > -kUnbounded; }

private:
    bool has_stock(const Edge& edge, double share) const
    {
        const Vec2d place = point_on(edge, share);
        return is_in_box(space_.spot, place) &&
               space_.swept.engagement(place, tangent_on(edge, share), -space_.sliver) >=
                   barely_open_;
    }

    // The piece of the edge that begins `at` mm along the contour.
    void add(const Edge& edge, int i, int n, double at)
    {
        const double radius = space_.swept.radius();
        const double size = length(edge);
        const double begin = at + size * i / n;
        const double end = at + size * (i + 1) / n;
        const Edge piece = between(edge, point_on(edge, static_cast<double>(i) / n),
                                   point_on(edge, (i + 1.0) / n));
        if (!space_.swept.keeps(piece, space_.max_engagement, space_.tolerance)) {
            if (!found_.empty()) {
                found_.back().to = std::min(found_.back().to, begin);
            }
            first_barrier_ = std::min(first_barrier_, begin);
            barrier_end_ = end;
            return;
        }
        const Stretch stock{std::max(begin - kBeyond * radius, barrier_end_),
                            end + kBeyond * radius};
        if (!found_.empty() && barrier_end_ <= found_.back().to &&
            stock.from < found_.back().to + kJoined * radius &&
            barrier_end_ <= found_.back().from) {
            found_.back().to = stock.to;
        } else {
            found_.push_back(stock);
        }
    }

    // The last stretch continues in the first one.
    void join_ends(double whole)
    {
        if (found_.size() > 1 && barrier_end_ <= found_.back().from &&
            first_barrier_ >= found_.front().to &&
            found_.front().from + whole < found_.back().to + kJoined * space_.swept.radius()) {
            found_.front().from = found_.back().from - whole;
            found_.pop_back();
        }
    }

    const Contour& contour_;
    const WallSpace& space_;
    double barely_open_;  // radians
    std::vector<Stretch> found_;
    double first_barrier_{kUnbounded};
    double barrier_end_{-kUnbounded};  // of the last one; none before 0
};

// Behind a corner in stock there is none to start from: the stretch from the first place that a
// lead reaches, and that lead; none where there is no such place near.
std::pair<std::vector<Edge>, std::optional<Edge>> begun_later(const Contour& contour,
                                                              Stretch stretch,
                                                              const WallSpace& space)
{
    constexpr double kLook = 0.2;   // radii
    constexpr double kMost = 12.0;  // radii
    const double radius = space.swept.radius();
    const double end = std::min(stretch.to - kBeyond * radius, stretch.from + kMost * radius);
    for (double from = stretch.from + kLook * radius; from < end; from += kLook * radius) {
        std::vector<Edge> path = part_of(contour, {from, stretch.to});
        if (const std::optional<Edge> lead = lead_in(path.front(), space)) {
            return {std::move(path), lead};
        }
    }
    return {};
}

}  // namespace

WallPasses uncut_stretches(const Contour& contour, const WallSpace& space)
{
    const double radius = space.swept.radius();
    const double whole = length(contour);
    StretchFinder finder{contour, space};
    WallPasses result;
    for (Stretch stretch : finder.find()) {
        if (stretch.to - stretch.from < kShortest) {
            continue;
        }
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
        std::optional<Edge> lead = lead_in(path.front(), space);
        if (!lead && space.max_engagement < kPi && is_in_stock(path.front().start, space)) {
            result.left = true;
            std::tie(path, lead) = begun_later(contour, stretch, space);
            if (!lead) {
                continue;
            }
        }
        if (lead) {
            path.insert(path.begin(), *lead);
        }
        if (const std::optional<Edge> out = lead_out(path.back(), space)) {
            path.push_back(*out);
        }
        result.paths.push_back(std::move(path));
    }
    result.left = result.left || finder.has_barrier();
    return result;
}

}  // namespace cusp::adaptive_clearing
