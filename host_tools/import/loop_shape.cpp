// Chains curves into loops and looks at the loops from above.
#include "host_tools/import/loop_shape.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/input_error/input_error.hpp"

#include "fmt/format.h"

namespace cusp::host {
namespace {

constexpr double kAllowedGap = 1e-3;  // mm
constexpr double kLeastLength = 1e-6;
// Chords for the questions of inside and of crossings.
constexpr double kChordTolerance = 1e-4;

Vec2d from_above(Vec3d p) { return {p.x, p.y}; }

double gap(Vec3d a, Vec3d b) { return norm(from_above(a) - from_above(b)); }

double polygon_length(const Curve& curve)
{
    double length = 0;
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
        length += gap(curve.points[i - 1], curve.points[i]);
    }
    return length;
}

// A stretch of a piece: its ends and its middle.
struct Stretch {
    double begin, end;  // parameters
    Vec2d a, middle, b;
};

// Halves the stretch until chords are flat; the depth bounds the work on wild parameters.
void add_chords(
    const Curve& piece, const Stretch& s, double tolerance, int depth, std::vector<Vec2d>& out)
{
    const double middle = (s.begin + s.end) / 2;
    const Vec2d first = from_above(point_at(piece, (s.begin + middle) / 2));
    const Vec2d last = from_above(point_at(piece, (middle + s.end) / 2));
    const Vec2d along = s.b - s.a;
    const double length = norm(along);
    double worst = 0;
    for (const Vec2d p : {first, s.middle, last}) {
        const double foot =
            length > 0 ? std::clamp(dot(p - s.a, along) / (length * length), 0.0, 1.0) : 0;
        worst = std::max(worst, norm(p - (s.a + foot * along)));
    }
    if (depth > 0 && worst > 0.75 * tolerance) {
        add_chords(piece, {s.begin, middle, s.a, first, s.middle}, tolerance, depth - 1, out);
        add_chords(piece, {middle, s.end, s.middle, last, s.b}, tolerance, depth - 1, out);
        return;
    }
    out.push_back(s.b);
}

struct Segment {
    Vec2d a, b;
    std::size_t loop;
    std::size_t index;  // in its loop
    std::size_t count;  // of the loop's segments
};

bool are_neighbours(const Segment& s, const Segment& t)
{
    const std::size_t apart = s.index > t.index ? s.index - t.index : t.index - s.index;
    return s.loop == t.loop && (apart <= 1 || apart + 1 >= s.count);
}

bool cross_properly(const Segment& s, const Segment& t)
{
    const double side_a = cross(t.b - t.a, s.a - t.a);
    const double side_b = cross(t.b - t.a, s.b - t.a);
    const double side_c = cross(s.b - s.a, t.a - s.a);
    const double side_d = cross(s.b - s.a, t.b - s.a);
    return side_a * side_b < 0 && side_c * side_d < 0;
}

// Precondition: they cross properly.
Vec2d meeting_point(const Segment& s, const Segment& t)
{
    const double before = std::abs(cross(t.b - t.a, s.a - t.a));
    const double after = std::abs(cross(t.b - t.a, s.b - t.a));
    return s.a + (before / (before + after)) * (s.b - s.a);
}

// The first crossing of two segments of closed polylines that are not neighbours.
std::optional<Vec2d> find_crossing(std::vector<Segment>& segments)
{
    const auto left = [](const Segment& s) {
        return std::min(s.a.x, s.b.x);
    };
    const auto right = [](const Segment& s) {
        return std::max(s.a.x, s.b.x);
    };
    std::sort(segments.begin(), segments.end(),
              [&](const Segment& s, const Segment& t) { return left(s) < left(t); });
    std::vector<const Segment*> open;
    for (const Segment& s : segments) {
        const auto passed = [&](const Segment* t) {
            return right(*t) < left(s);
        };
        open.erase(std::remove_if(open.begin(), open.end(), passed), open.end());
        for (const Segment* t : open) {
            if (!are_neighbours(s, *t) && cross_properly(s, *t)) {
                return meeting_point(s, *t);
            }
        }
        open.push_back(&s);
    }
    return std::nullopt;
}

void check_simple(const std::vector<Vec2d>& closed, const std::string& place)
{
    if (const auto at = crossing_of({closed})) {
        throw InputError(
            fmt::format("{}: the loop crosses itself near x {:.3f} y {:.3f}", place, at->x, at->y));
    }
}

}  // namespace

std::optional<Vec2d> crossing_of(const std::vector<std::vector<Vec2d>>& closed)
{
    std::vector<Segment> segments;
    for (std::size_t loop = 0; loop < closed.size(); ++loop) {
        const std::vector<Vec2d>& polyline = closed[loop];
        for (std::size_t i = 0; i + 1 < polyline.size(); ++i) {
            segments.push_back({polyline[i], polyline[i + 1], loop, i, polyline.size() - 1});
        }
    }
    return find_crossing(segments);
}

std::vector<Vec2d> loop_polyline(const Loop& loop, double tolerance)
{
    constexpr int kDepth = 16;
    std::vector<Vec2d> out;
    for (const Curve& curve : loop) {
        if (out.empty()) {
            out.push_back(from_above(point_at(curve, curve.domain_begin())));
        }
        for (const Curve& piece : bezier_pieces(curve)) {
            const double begin = piece.domain_begin();
            const double end = piece.domain_end();
            if (curve.degree == 1) {
                out.push_back(from_above(piece.points.back()));
                continue;
            }
            // a piece may begin and end in an inflection that three samples miss
            constexpr int kParts = 4;
            for (int i = 0; i < kParts; ++i) {
                const double from = begin + i * (end - begin) / kParts;
                const double to = i + 1 == kParts ? end : begin + (i + 1) * (end - begin) / kParts;
                const auto at = [&piece](double u) {
                    return from_above(point_at(piece, u));
                };
                add_chords(piece, {from, to, at(from), at((from + to) / 2), at(to)}, tolerance,
                           kDepth, out);
            }
        }
    }
    if (!out.empty()) {
        out.back() = out.front();
    }
    return out;
}

double signed_area(const std::vector<Vec2d>& closed)
{
    double twice = 0;
    for (std::size_t i = 0; i + 1 < closed.size(); ++i) {
        twice += cross(closed[i] - closed[0], closed[i + 1] - closed[0]);
    }
    return twice / 2;
}

bool encloses(const std::vector<Vec2d>& closed, Vec2d point)
{
    bool inside = false;
    for (std::size_t i = 0; i + 1 < closed.size(); ++i) {
        const Vec2d a = closed[i];
        const Vec2d b = closed[i + 1];
        if ((a.y <= point.y) != (b.y <= point.y) &&
            point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x) {
            inside = !inside;
        }
    }
    return inside;
}

Loop reversed(const Loop& loop)
{
    Loop back;
    for (auto curve = loop.rbegin(); curve != loop.rend(); ++curve) {
        back.push_back(reversed(*curve));
    }
    return back;
}

Loop chained(Loop loop, double allowed_gap, const std::string& place)
{
    if (loop.empty()) {
        throw InputError(place + ": the loop holds no curve");
    }
    for (std::size_t i = 0; i < loop.size(); ++i) {
        if (!(polygon_length(loop[i]) > kLeastLength * allowed_gap / kAllowedGap)) {
            throw InputError(fmt::format("{}: curve {} has no length", place, i + 1));
        }
    }
    if (loop.size() > 1) {
        const Vec3d end = loop[0].points.back();
        const Vec3d begin = loop[0].points.front();
        const auto nearest = [&](Vec3d p) {
            return std::min(gap(p, loop[1].points.front()), gap(p, loop[1].points.back()));
        };
        if (nearest(end) > allowed_gap && nearest(begin) <= allowed_gap) {
            loop[0] = reversed(loop[0]);
        }
    }
    for (std::size_t i = 0; i < loop.size(); ++i) {
        Curve& next = loop[(i + 1) % loop.size()];
        const Vec3d end = loop[i].points.back();
        if (i + 1 < loop.size() && gap(end, next.points.front()) > allowed_gap &&
            gap(end, next.points.back()) <= allowed_gap) {
            next = reversed(next);
        }
        const double open = gap(end, next.points.front());
        if (open > allowed_gap) {
            throw InputError(fmt::format(
                "{}: the loop is open: from the end of curve {} (x {:.6g} "
                "y {:.6g}) to the start of curve {} it is {:.6g}, "
                "allowed {:g}",
                place, i + 1, end.x, end.y, (i + 1) % loop.size() + 1, open, allowed_gap));
        }
        next.points.front().x = end.x;
        next.points.front().y = end.y;
    }
    return loop;
}

Loop closed_loop(const Loop& loop, const std::string& place)
{
    const Loop chain = chained(loop, kAllowedGap, place);
    const std::vector<Vec2d> closed = loop_polyline(chain, kChordTolerance);
    check_simple(closed, place);
    const double area = signed_area(closed);
    constexpr double kLeastArea = 1e-6;
    if (!(std::abs(area) > kLeastArea)) {
        throw InputError(
            fmt::format("{}: the loop encloses {:.3g} mm^2, that is no area", place, area));
    }
    return area < 0 ? reversed(chain) : chain;
}

bool lies_outside(const std::vector<Vec2d>& inner, const std::vector<Vec2d>& outer)
{
    return std::none_of(inner.begin(), inner.end(),
                        [&](Vec2d point) { return encloses(outer, point); });
}

}  // namespace cusp::host
