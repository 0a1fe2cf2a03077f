// From each place on a wall the largest circle that touches it there is found by shrinking: it goes
// through the place and the point of a wall that is nearest to its centre.
#include "host_tools/cam/adaptive_clearing/neck_ways.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::adaptive_clearing {

using offset::Contour;
using offset::Edge;
using offset::EdgeTree;
using offset::left_normal;
using offset::length;
using offset::point_on;
using offset::RegionOffset;
using offset::tangent_at_end;
using offset::tangent_at_start;
using offset::tangent_on;
using offset::unit;

namespace {

constexpr double kOpposite = 5.0 / 6 * kPi;    // between the two places that a circle touches
constexpr double kBesideNeck = 4.0 / 9 * kPi;  // of the rest of a way: into square corners too
constexpr double kLeastBeside = 0.25;          // of the least room
constexpr double kFarthestCentre = 4.0;        // pitches from one centre to the next
constexpr double kTouching = 1e-6;             // mm
constexpr int kFiner = 8;                      // than a pitch
constexpr int kShrinks = 40;

struct Station {
    NeckPlace place;
    double between;  // radians: between the places that the circle touches
};

struct TouchingCircle {
    double radius;   // mm
    double between;  // radians: between the places that it touches
};

// The largest circle of at most this radius that touches the wall at the place; of radius 0 where none is found.
TouchingCircle touching_circle(const RegionOffset& walls, Vec2d at, Vec2d inward, double radius)
{
    Vec2d other = at;
    bool touches = false;
    for (int i = 0; i < kShrinks; ++i) {
        const EdgeTree::Nearest nearest = walls.nearest_edge(at + inward * radius);
        const Vec2d to = nearest.point - at;
        const double depth = dot(to, inward);
        touches = nearest.distance > radius - kTouching;
        if (touches || depth <= 0.0) {
            break;
        }
        other = nearest.point;
        radius = dot(to, to) / (2.0 * depth);
    }
    const Vec2d centre = at + inward * radius;
    if (!touches || !walls.contains(centre)) {
        return {0, 0};
    }
    const Vec2d u = at - centre;
    const Vec2d v = other - centre;
    return {radius, std::abs(elementary::atan2(cross(u, v), dot(u, v)))};
}

class NeckFinder {
public:
    NeckFinder(const RegionOffset& walls, const NeckLimits& limits) : limits_{limits}, walls_{walls}
    {
    }

    void visit(const Contour& contour)
    {
        stations_.clear();
        const Edge* before = &contour.back();
        for (const Edge& edge : contour) {
            visit_corner(tangent_at_end(*before), tangent_at_start(edge), edge.start);
            visit_edge(edge);
            before = &edge;
        }
        divide();
    }

    std::vector<NeckWay> ways() { return std::move(ways_); }

private:
    void visit_edge(const Edge& edge)
    {
        const int n = std::max(1, static_cast<int>(std::ceil(length(edge) / limits_.pitch)));
        for (int i = 0; i < n; ++i) {
            // Near a corner at the end of a slot the circles shrink fast.
            const int parts =
                is_wide(point_on(edge, (i + 0.5) / n), left_normal(tangent_on(edge, (i + 0.5) / n)))
                    ? 1
                    : kFiner;
            for (int k = 0; k < parts; ++k) {
                const double share = (i + (k + 0.5) / parts) / n;
                visit_place(point_on(edge, share), left_normal(tangent_on(edge, share)));
            }
        }
    }

    bool is_wide(Vec2d at, Vec2d inward) const
    {
        const double radius = limits_.wall_clearance + limits_.most_room_beside;
        return !walls_.any_nearer(at + inward * radius, radius - kTouching);
    }

    // About a corner that points into the region the circles turn.
    void visit_corner(Vec2d before, Vec2d after, Vec2d corner)
    {
        const double turn = elementary::atan2(cross(before, after), dot(before, after));
        const double reach = limits_.wall_clearance + limits_.most_room_beside;
        const int n = static_cast<int>(std::ceil(-turn * reach / limits_.pitch));
        for (int i = 0; i < n; ++i) {
            const double angle = turn * (i + 0.5) / n;
            const Vec2d n0 = left_normal(before);
            visit_place(corner,
                        n0 * elementary::cos(angle) + left_normal(n0) * elementary::sin(angle));
        }
    }

    void visit_place(Vec2d at, Vec2d inward)
    {
        if (is_wide(at, inward)) {
            stations_.emplace_back();
            return;
        }
        const TouchingCircle circle =
            touching_circle(walls_, at, inward, limits_.wall_clearance + limits_.most_room_beside);
        const double room = circle.radius - limits_.wall_clearance;
        if (room < kLeastBeside * limits_.least_room || circle.between < kBesideNeck) {
            stations_.emplace_back();
        } else {
            stations_.emplace_back(Station{{at + inward * circle.radius, room}, circle.between});
        }
    }

    // Ways are what lies between stations that are in no neck.
    void divide()
    {
        const std::size_t n = stations_.size();
        const auto first = std::find_if(stations_.begin(), stations_.end(),
                                        [](const auto& station) { return !station; });
        const bool closed = first == stations_.end();
        std::rotate(stations_.begin(), closed ? stations_.begin() : first, stations_.end());
        if (closed && n > 0) {
            stations_.push_back(stations_.front());
        }
        NeckWay way;
        bool is_neck = false;
        const auto end = [&] {
            if (is_neck) {
                ways_.push_back(std::move(way));
            }
            way.clear();
            is_neck = false;
        };
        for (const std::optional<Station>& station : stations_) {
            if (!station || (!way.empty() && norm(station->place.centre - way.back().centre) >
                                                 kFarthestCentre * limits_.pitch)) {
                end();
            }
            if (station) {
                way.push_back(station->place);
                is_neck = is_neck || (station->between >= kOpposite &&
                                      station->place.room >= limits_.least_room &&
                                      station->place.room <= limits_.most_room);
            }
        }
        end();
    }

    const NeckLimits& limits_;
    const RegionOffset& walls_;
    std::vector<std::optional<Station>> stations_;
    std::vector<NeckWay> ways_;
};

}  // namespace

std::optional<double> slot_width(const RegionOffset& walls, Vec2d place, double most)
{
    const Vec2d at = walls.nearest_edge(place).point;
    const TouchingCircle circle = touching_circle(walls, at, unit(place - at), 0.5 * most);
    return circle.between < kOpposite ? std::nullopt : std::optional{2.0 * circle.radius};
}

std::vector<NeckWay> neck_ways(const RegionOffset& walls, const NeckLimits& limits)
{
    NeckFinder finder{walls, limits};
    for (const Contour& contour : walls.source().contours) {
        finder.visit(contour);
    }
    return finder.ways();
}

}  // namespace cusp::adaptive_clearing
