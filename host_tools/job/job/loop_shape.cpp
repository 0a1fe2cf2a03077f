// Chains curves into loops, and tests their polylines.
#include "host_tools/job/job/loop_shape.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/input_error.hpp"

#include "fmt/format.h"

namespace cusp::job {

using nurbs::Curve;

namespace {

constexpr double kAllowedGap = 1e-3;  // mm
constexpr double kLeastLength = 1e-6;
// Chord tolerance for the tests of containment and crossings, mm.
constexpr double kChordTolerance = 1e-4;

double gap(Vec3d a, Vec3d b) { return norm(in_plan(a) - in_plan(b)); }

double polygon_length(const Curve& curve)
{
    double length = 0;
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
        length += gap(curve.points[i - 1], curve.points[i]);
    }
    return length;
}

// A point in plan in homogeneous coordinates.
struct Weighted {
    double x, y, weight;

    Vec2d place() const { return weight == 1.0 ? Vec2d{x, y} : Vec2d{x / weight, y / weight}; }
};

Weighted middle_of(const Weighted& a, const Weighted& b)
{
    return {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.weight + b.weight) / 2};
}

double distance_to_chord(Vec2d p, Vec2d a, Vec2d b)
{
    const Vec2d along = b - a;
    const double square = dot(along, along);
    const double foot = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0;
    return norm(p - (a + foot * along));
}

// Chords of a Bezier piece, bisected until its control points prove it flat. kDepth bounds the
// recursion.
class PieceChords {
public:
    PieceChords(const Curve& piece, double tolerance, std::vector<Vec2d>& out)
        : count_{piece.points.size()},
          share_of_ends_{std::ldexp(1.0, 2 - static_cast<int>(count_))},
          tolerance_{tolerance},
          out_{out}
    {
        polygons_.resize((kDepth + 1) * count_);
        for (std::size_t i = 0; i < count_; ++i) {
            const double w = piece.weights[i];
            polygons_[i] = {piece.points[i].x * w, piece.points[i].y * w, w};
        }
    }

    void run() { add(polygons_.data(), 0); }

private:
    static constexpr std::size_t kDepth = 18;

    // A point of the curve is a weighted mean of control points; the ends have a least weight.
    bool is_flat(const Weighted* polygon) const
    {
        const Vec2d a = polygon[0].place();
        const Vec2d b = polygon[count_ - 1].place();
        double farthest = 0;
        double heaviest = 0;
        for (std::size_t i = 1; i + 1 < count_; ++i) {
            farthest = std::max(farthest, distance_to_chord(polygon[i].place(), a, b));
            heaviest = std::max(heaviest, polygon[i].weight);
        }
        const double ends =
            share_of_ends_ * std::min(polygon[0].weight, polygon[count_ - 1].weight);
        const double inner = (1 - share_of_ends_) * heaviest;
        return farthest * inner <= tolerance_ * (inner + ends);
    }

    // The halves are stored behind `polygon`.
    void add(Weighted* polygon, std::size_t depth)
    {
        if (depth == kDepth || is_flat(polygon)) {
            out_.push_back(polygon[count_ - 1].place());
            return;
        }
        Weighted* const first = polygon + count_;
        for (std::size_t level = 0; level < count_; ++level) {
            first[level] = polygon[0];
            for (std::size_t k = 0; k + level + 1 < count_; ++k) {
                polygon[k] = middle_of(polygon[k], polygon[k + 1]);
            }
        }
        add(first, depth + 1);
        add(polygon, depth + 1);
    }

    std::size_t count_;
    double share_of_ends_;  // least sum of the ends' Bernstein polynomials
    double tolerance_;
    std::vector<Vec2d>& out_;
    std::vector<Weighted> polygons_;
};

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

bool cross_properly(const Segment& s, const Segment& t, double touching)
{
    const double side_a = cross(t.b - t.a, s.a - t.a);
    const double side_b = cross(t.b - t.a, s.b - t.a);
    const double side_c = cross(s.b - s.a, t.a - s.a);
    const double side_d = cross(s.b - s.a, t.b - s.a);
    if (!(side_a * side_b < 0 && side_c * side_d < 0)) {
        return false;
    }
    return !(touching > 0) ||
           (std::min(std::abs(side_a), std::abs(side_b)) > touching * norm(t.b - t.a) &&
            std::min(std::abs(side_c), std::abs(side_d)) > touching * norm(s.b - s.a));
}

// Precondition: they cross properly.
Vec2d meeting_point(const Segment& s, const Segment& t)
{
    const double before = std::abs(cross(t.b - t.a, s.a - t.a));
    const double after = std::abs(cross(t.b - t.a, s.b - t.a));
    return s.a + (before / (before + after)) * (s.b - s.a);
}

// The first crossing of two segments of closed polylines that are not neighbours.
std::optional<Vec2d> find_crossing(std::vector<Segment>& segments, double touching)
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
            if (!are_neighbours(s, *t) && cross_properly(s, *t, touching)) {
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

std::optional<Vec2d> crossing_of(const std::vector<std::vector<Vec2d>>& closed, double touching)
{
    std::vector<Segment> segments;
    std::size_t count = 0;
    for (const std::vector<Vec2d>& polyline : closed) {
        count += polyline.size();
    }
    segments.reserve(count);
    for (std::size_t loop = 0; loop < closed.size(); ++loop) {
        const std::vector<Vec2d>& polyline = closed[loop];
        for (std::size_t i = 0; i + 1 < polyline.size(); ++i) {
            segments.push_back({polyline[i], polyline[i + 1], loop, i, polyline.size() - 1});
        }
    }
    return find_crossing(segments, touching);
}

std::vector<Vec2d> loop_polyline(const Loop& loop, double tolerance)
{
    std::vector<Vec2d> out;
    for (const Curve& curve : loop) {
        if (out.empty()) {
            out.push_back(in_plan(point_at(curve, curve.domain_begin())));
        }
        for (const Curve& piece : bezier_pieces(curve)) {
            if (curve.degree == 1) {
                out.push_back(in_plan(piece.points.back()));
                continue;
            }
            PieceChords{piece, tolerance, out}.run();
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

Loop closed_loop(const Loop& loop, const std::string& place, double allowed_gap)
{
    const Loop chain = chained(loop, allowed_gap, place);
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

}  // namespace cusp::job
