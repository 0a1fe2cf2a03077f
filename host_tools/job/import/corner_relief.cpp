// A relief is the strip with a round end that the tool sweeps on its way into the corner.
#include "host_tools/job/import/corner_relief.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/job/import/drawn_shapes.hpp"
#include "host_tools/job/job/loop_shape.hpp"

namespace cusp::import {

using job::Loop;
using nurbs::Curve;

namespace {

constexpr double kStraight = 0.1736;  // sine of 10 degrees
constexpr double kNothing = 1e-6;     // mm

// A side of the loop, and what reliefs take off its ends.
struct LoopSide {
    Curve curve;
    double at_start{};  // mm
    double at_end{};

    bool is_line() const { return curve.degree == 1; }
    Vec2d start() const { return in_plan(curve.points.front()); }
    Vec2d end() const { return in_plan(curve.points.back()); }
    double length() const { return norm(end() - start()); }
    Vec2d along() const { return (end() - start()) * (1 / length()); }
};

// The way round a corner: from `from` to `to`, on a round end between straight parts.
struct Way {
    Vec2d from, to;
    Vec2d arc_begin, arc_end;
    Vec2d centre;
};

// A corner with the tool on its left: the sides lead away from it.
struct Corner {
    Vec2d at;
    Vec2d back;   // along the side before, of length 1
    Vec2d ahead;  // along the side after
};

// mm: from the corner along a side to the edge of the strip, or to its round end. Sine and cosine are of the angle
// between the side and the middle of the strip.
double reach(double sine, double cosine, double radius)
{
    return cosine > sine ? radius / sine : 2 * radius * cosine;
}

Way dogbone(const Corner& c, double radius)
{
    const Vec2d sum = c.back + c.ahead;
    const Vec2d middle = sum * (1 / norm(sum));
    const double cosine = dot(middle, c.back);
    const double sine = std::fabs(cross(middle, c.back));
    const double length = reach(sine, cosine, radius);
    const Vec2d aside = (c.back - middle * cosine) * (1 / sine);
    Way way{c.at + c.back * length, c.at + c.ahead * length, {}, {}, c.at + middle * radius};
    const bool is_strip = cosine > sine;
    way.arc_begin = is_strip ? way.centre + aside * radius : way.from;
    way.arc_end = is_strip ? way.centre - aside * radius : way.to;
    return way;
}

// along  the side that the tool goes along, from the corner; other: the side that it cuts into
Way t_bone(const Corner& c, Vec2d along, Vec2d other, double radius)
{
    const double cosine = dot(along, other);
    const Vec2d square = (other - along * cosine) * (1 / std::fabs(cross(along, other)));
    const double sine = dot(square, other);
    const bool is_strip = cosine > 0;
    const double length = is_strip ? 2 * radius / sine : 2 * radius * sine;
    Way way{c.at, c.at + other * length, c.at, {}, c.at + square * radius};
    way.arc_end = is_strip ? c.at + square * (2 * radius) : way.to;
    return way;
}

Way turned(const Way& way) { return {way.to, way.from, way.arc_end, way.arc_begin, way.centre}; }

void add_way(const Way& way, Loop& loop)
{
    const auto line = [&](Vec2d a, Vec2d b) {
        if (norm(b - a) > kNothing) {
            loop.push_back(line_curve(a, b));
        }
    };
    const Vec2d a = way.arc_begin - way.centre;
    const Vec2d b = way.arc_end - way.centre;
    const double sweep = elementary::atan2(cross(a, b), dot(a, b));
    line(way.from, way.arc_begin);
    loop.push_back(arc_curve(way.centre, norm(a), elementary::atan2(a.y, a.x),
                             sweep > 0 ? sweep : sweep + 2 * kPi));
    line(way.arc_end, way.to);
}

std::vector<LoopSide> sides_of(const Loop& loop)
{
    std::vector<LoopSide> sides;
    for (const Curve& curve : loop) {
        if (curve.degree != 1) {
            sides.push_back({curve});
            continue;
        }
        for (std::size_t k = 0; k + 1 < curve.points.size(); ++k) {
            if (norm(in_plan(curve.points[k + 1]) - in_plan(curve.points[k])) > kNothing) {
                sides.push_back(
                    {line_curve(in_plan(curve.points[k]), in_plan(curve.points[k + 1]))});
            }
        }
    }
    return sides;
}

std::optional<Way> way_round(const LoopSide& before,
                             const LoopSide& after,
                             const CornerRelief& relief)
{
    if (!before.is_line() || !after.is_line() || norm(before.end() - after.start()) > 1e-3) {
        return std::nullopt;
    }
    if (cross(before.along(), after.along()) < kStraight) {
        return std::nullopt;
    }
    const Corner corner{after.start(), before.along() * -1.0, after.along()};
    const double radius = relief.tool_radius + kReliefRoom;
    if (relief.kind == ReliefKind::kDogbone) {
        return dogbone(corner, radius);
    }
    return before.length() > after.length()
               ? t_bone(corner, corner.back, corner.ahead, radius)
               : turned(t_bone(corner, corner.ahead, corner.back, radius));
}

}  // namespace

Loop with_reliefs(const Loop& loop,
                  bool tool_inside,
                  const CornerRelief& relief,
                  std::size_t& left_out)
{
    std::vector<LoopSide> sides = sides_of(tool_inside ? loop : job::reversed(loop));
    const std::size_t count = sides.size();
    std::vector<std::optional<Way>> ways(count);  // before each side
    for (std::size_t k = 0; k < count && count > 1; ++k) {
        LoopSide& before = sides[(k + count - 1) % count];
        LoopSide& after = sides[k];
        ways[k] = way_round(before, after, relief);
        if (!ways[k]) {
            continue;
        }
        before.at_end = norm(ways[k]->from - before.end());
        after.at_start = norm(ways[k]->to - after.start());
        if (2 * before.at_end > before.length() || 2 * after.at_start > after.length()) {
            before.at_end = after.at_start = 0;
            ways[k] = std::nullopt;
            ++left_out;
        }
    }
    Loop out;
    for (std::size_t k = 0; k < count; ++k) {
        const LoopSide& side = sides[k];
        if (ways[k]) {
            add_way(*ways[k], out);
        }
        if (side.at_start > 0 || side.at_end > 0) {
            const Vec2d a = side.start() + side.along() * side.at_start;
            const Vec2d b = side.end() - side.along() * side.at_end;
            if (norm(b - a) > kNothing) {
                out.push_back(line_curve(a, b));
            }
        } else {
            out.push_back(side.curve);
        }
    }
    return tool_inside ? out : job::reversed(out);
}

std::size_t add_reliefs(const CornerRelief& relief, job::Operation& operation)
{
    std::size_t left_out = 0;
    const auto change = [&](Loop& loop, bool tool_inside) {
        loop = with_reliefs(loop, tool_inside, relief, left_out);
    };
    if (operation.outline.boundary) {
        change(*operation.outline.boundary, true);
    }
    for (Loop& island : operation.outline.islands) {
        change(island, false);
    }
    if (operation.prismatic) {
        const bool inside = operation.prismatic->side == job::ProfileSide::kInside;
        for (job::NestedLoop& loop : operation.prismatic->loops) {
            change(loop.loop, loop.hole != inside);
        }
    }
    return left_out;
}

}  // namespace cusp::import
