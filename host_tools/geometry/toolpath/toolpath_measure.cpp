// Walks a tool path move by move.
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/toolpath/arc_geometry.hpp"

namespace cusp::toolpath {

using nurbs::Curve;

namespace {

// Data of one move for the estimate of time.
struct Stretch {
    double length;
    double velocity;      // at most, mm/s
    double acceleration;  // along the way, mm/s^2
    double jerk;          // the same, mm/s^3
    Vec3d first_tangent;
    Vec3d last_tangent;
};

struct Geometry {
    double length;
    Vec3d first_tangent;
    Vec3d last_tangent;
    double least_radius;  // mm; 0 where straight
};

Vec3d unit_or_zero(Vec3d v)
{
    const double size = norm(v);
    return size > 0 ? v / size : Vec3d{};
}

Geometry geometry_of(const LineTo& line, Vec3d start)
{
    const Vec3d way = line.end - start;
    const Vec3d along = unit_or_zero(way);
    return {norm(way), along, along, 0};
}

Geometry geometry_of(const ArcTo& to, Vec3d start)
{
    const ArcShape arc = arc_shape(start, to);
    return {length(arc), tangent_on(arc, 0), tangent_on(arc, 1), arc.start_radius};
}

Geometry geometry_of(const NurbsTo& to, Vec3d start)
{
    Geometry out{0, unit_or_zero(derivatives_at(to.curve, to.curve.domain_begin()).first),
                 unit_or_zero(derivatives_at(to.curve, to.curve.domain_end()).first), 0};
    constexpr double kChord = 1e-3;
    Vec3d last = start;
    for (const Vec3d p : points_of({MoveKind::kCut, to}, start, kChord)) {
        out.length += norm(p - last);
        last = p;
    }
    return out;
}

// The largest speed along a direction for which no axis is above its own limit.
double along(Vec3d direction, Vec3d limit)
{
    constexpr double kNoDirection = 1e9;  // the tangent at a standstill has length 0
    double most = kNoDirection;
    for (unsigned axis = 0; axis < 3; ++axis) {
        const double share = std::abs(direction[axis]);
        if (share > 0) {
            most = std::min(most, limit[axis] / share);
        }
    }
    return most;
}

Stretch stretch_of(const Geometry& g, double feed, const MachineRates& rates)
{
    const double acceleration = std::min(along(g.first_tangent, rates.acceleration),
                                         along(g.last_tangent, rates.acceleration));
    double velocity = std::min(
        {feed, along(g.first_tangent, rates.velocity), along(g.last_tangent, rates.velocity)});
    if (g.least_radius > 0) {
        velocity = std::min(velocity, std::sqrt(acceleration * g.least_radius));
    }
    const double jerk =
        std::min(along(g.first_tangent, rates.jerk), along(g.last_tangent, rates.jerk));
    return {g.length, velocity, acceleration, jerk, g.first_tangent, g.last_tangent};
}

// Square of the speed at the corner between two stretches.
double corner_speed_squared(const Stretch& a, const Stretch& b, bool exact_stop)
{
    constexpr double kStraight = 0.99996192;  // cosine of 0.5 degrees
    constexpr double kDeviation = 0.01;       // mm: the controller's tolerance at power-up
    const double turn = dot(a.last_tangent, b.first_tangent);
    const double limit = std::min(a.velocity, b.velocity);
    if (turn >= kStraight) {
        return limit * limit;
    }
    if (exact_stop || turn < -kStraight) {
        return 0;
    }
    const double half_sine = std::sqrt((1 + turn) / 2);
    const double squared =
        std::min(a.acceleration, b.acceleration) * kDeviation * half_sine / (1 - half_sine);
    return std::min(limit * limit, squared);
}

double seconds_of(const Stretch& s, double begin_squared, double end_squared)
{
    const double peak_squared = std::min(
        s.velocity * s.velocity, (2 * s.acceleration * s.length + begin_squared + end_squared) / 2);
    const double peak = std::sqrt(std::max({peak_squared, begin_squared, end_squared}));
    if (!(peak > 0)) {
        return 0;
    }
    const double ramps = (2 * peak * peak - begin_squared - end_squared) / (2 * s.acceleration);
    return (2 * peak - std::sqrt(begin_squared) - std::sqrt(end_squared)) / s.acceleration +
           std::max(0.0, s.length - ramps) / peak;
}

// Time from rest to rest with limited jerk; infinite jerk gives the trapezoid.
double rest_to_rest(double length, double velocity, double acceleration, double jerk)
{
    const double rise = acceleration / jerk;    // s
    const double gained = acceleration * rise;  // mm/s until the acceleration is full and back
    // The speed at which the two ramps take all of the length.
    double peak = std::sqrt(acceleration * length + 0.25 * gained * gained) - 0.5 * gained;
    if (peak < gained) {
        peak = elementary::cbrt(0.25 * length * length * jerk);
    }
    peak = std::min(peak, velocity);
    const double ramp = peak > gained ? peak / acceleration + rise : 2 * std::sqrt(peak / jerk);
    return 2 * ramp + std::max(0.0, length - peak * ramp) / peak;
}

// Time that the jerk limit adds between two stops.
class JerkTime {
public:
    void add(const Stretch& s)
    {
        length_ += s.length;
        velocity_ += s.length * s.velocity;
        acceleration_ = std::min(acceleration_, s.acceleration);
        jerk_ = std::min(jerk_, s.jerk);
    }
    double take()
    {
        const double velocity = velocity_ / length_;
        const double more = rest_to_rest(length_, velocity, acceleration_, jerk_) -
                            rest_to_rest(length_, velocity, acceleration_, kInfinite);
        *this = {};
        return more;
    }

private:
    double length_{};
    double velocity_{};  // times the length
    double acceleration_{kInfinite};
    double jerk_{kInfinite};
};

double estimated_seconds(const std::vector<Stretch>& stretches, bool exact_stop)
{
    if (stretches.empty()) {
        return 0;
    }
    std::vector<double> squared(stretches.size() + 1, 0.0);
    for (std::size_t i = 1; i < stretches.size(); ++i) {
        squared[i] = corner_speed_squared(stretches[i - 1], stretches[i], exact_stop);
    }
    for (std::size_t i = stretches.size(); i-- > 0;) {
        squared[i] = std::min(squared[i],
                              squared[i + 1] + 2 * stretches[i].acceleration * stretches[i].length);
    }
    double seconds = 0;
    JerkTime jerk;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        squared[i + 1] = std::min(squared[i + 1],
                                  squared[i] + 2 * stretches[i].acceleration * stretches[i].length);
        seconds += seconds_of(stretches[i], squared[i], squared[i + 1]);
        jerk.add(stretches[i]);
        if (squared[i + 1] == 0) {
            seconds += jerk.take();
        }
    }
    return seconds;
}

void count(const ToolMove& move, MoveCounts& counts)
{
    if (move.kind == MoveKind::kRapid) {
        ++counts.rapids;
    } else if (std::holds_alternative<LineTo>(move.shape)) {
        ++counts.lines;
    } else if (std::holds_alternative<ArcTo>(move.shape)) {
        ++counts.arcs;
    } else {
        ++counts.nurbs;
    }
}

void add_arc_points(const ArcShape& arc, double tolerance, std::vector<Vec3d>& out)
{
    const double radius = std::max({arc.start_radius, arc.end_radius, tolerance});
    const double step = 2 * elementary::acos(std::max(0.0, 1 - tolerance / radius));
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(arc.sweep) / step)));
    for (int i = 1; i <= steps; ++i) {
        out.push_back(point_on(arc, static_cast<double>(i) / steps));
    }
}

double distance_to_chord(Vec3d p, Vec3d a, Vec3d b)
{
    const Vec3d chord = b - a;
    const double squared = dot(chord, chord);
    const double foot = squared > 0 ? std::clamp(dot(p - a, chord) / squared, 0.0, 1.0) : 0.0;
    return norm(p - (a + foot * chord));
}

// Halves the stretch until its chord is flat; the depth bounds the work.
void add_chords(const Curve& curve,
                double begin,
                double end,
                double tolerance,
                int depth,
                std::vector<Vec3d>& out)
{
    const Vec3d a = point_at(curve, begin);
    const Vec3d b = point_at(curve, end);
    double worst = 0;
    for (const double share : {0.25, 0.5, 0.75}) {
        worst = std::max(worst,
                         distance_to_chord(point_at(curve, begin + share * (end - begin)), a, b));
    }
    if (depth > 0 && worst > 0.75 * tolerance) {
        const double middle = (begin + end) / 2;
        add_chords(curve, begin, middle, tolerance, depth - 1, out);
        add_chords(curve, middle, end, tolerance, depth - 1, out);
        return;
    }
    out.push_back(b);
}

void add_curve_points(const Curve& curve, double tolerance, std::vector<Vec3d>& out)
{
    constexpr int kDepth = 14;
    constexpr int kParts = 4;  // against inflections that three samples miss
    for (const Curve& piece : bezier_pieces(curve)) {
        const double step = (piece.domain_end() - piece.domain_begin()) / kParts;
        for (int i = 0; i < kParts; ++i) {
            const double begin = piece.domain_begin() + i * step;
            add_chords(piece, begin, begin + step, tolerance, kDepth, out);
        }
    }
}

// The part of a straight move that is above z.
double length_above(Vec3d a, Vec3d b, double z)
{
    const double low = std::min(a.z, b.z);
    const double high = std::max(a.z, b.z);
    return high <= z ? 0 : norm(b - a) * (low >= z ? 1 : (high - z) / (high - low));
}

}  // namespace

Vec3d end_of(const ToolMove& move)
{
    if (const auto* line = std::get_if<LineTo>(&move.shape)) {
        return line->end;
    }
    if (const auto* arc = std::get_if<ArcTo>(&move.shape)) {
        return arc->end;
    }
    const Curve& curve = std::get<NurbsTo>(move.shape).curve;
    return point_at(curve, curve.domain_end());
}

std::vector<Vec3d> points_of(const ToolMove& move, Vec3d start, double tolerance)
{
    std::vector<Vec3d> out;
    if (const auto* line = std::get_if<LineTo>(&move.shape)) {
        out.push_back(line->end);
    } else if (const auto* arc = std::get_if<ArcTo>(&move.shape)) {
        add_arc_points(arc_shape(start, *arc), tolerance, out);
    } else {
        add_curve_points(std::get<NurbsTo>(move.shape).curve, tolerance, out);
    }
    return out;
}

double steepest_descent(const ToolMove& move, Vec3d start)
{
    constexpr double kChord = 1e-3;
    const bool arc = std::holds_alternative<ArcTo>(move.shape);
    double steepest = 0;
    Vec3d at = start;
    for (const Vec3d p : points_of(move, start, kChord)) {
        const double way = norm(p - at);
        steepest = way > 0 ? std::max(steepest, (at.z - p.z) / way) : steepest;
        at = p;
    }
    if (!arc) {
        return steepest;
    }
    // A helix has one slope; its chords are a little shorter and would be steeper.
    const ArcShape shape = arc_shape(start, std::get<ArcTo>(move.shape));
    return shape.axes[2] == 2 ? std::max(0.0, -tangent_on(shape, 0.5).z) : steepest;
}

double feed_of(const Toolpath& path, const ToolMove& move, Vec3d start)
{
    if (move.kind == MoveKind::kRapid) {
        return 0;
    }
    if (move.kind == MoveKind::kPlunge) {
        return path.plunge_feed;
    }
    if (move.feed > 0) {
        return move.feed;
    }
    const double down = move.kind == MoveKind::kPlungingCut ? steepest_descent(move, start) : 0;
    return down * path.feed > path.plunge_feed ? path.plunge_feed / down : path.feed;
}

double cut_length_above(const Toolpath& path, Vec3d start, double z)
{
    constexpr double kChord = 0.01;  // mm
    double length = 0;
    Vec3d at = start;
    for (const ToolMove& move : path.moves) {
        if (move.kind == MoveKind::kRapid) {
            at = end_of(move);
            continue;
        }
        for (const Vec3d p : points_of(move, at, kChord)) {
            length += length_above(at, p, z);
            at = p;
        }
    }
    return length;
}

PathMeasure measure(const Toolpath& path, Vec3d start, const MachineRates& rates)
{
    constexpr double kSecondsPerMinute = 60.0;
    PathMeasure sum;
    std::vector<Stretch> stretches;
    Vec3d at = start;
    for (const ToolMove& move : path.moves) {
        count(move, sum.moves);
        const Geometry g =
            std::visit([&](const auto& shape) { return geometry_of(shape, at); }, move.shape);
        (move.kind == MoveKind::kRapid ? sum.rapid_length_mm : sum.cut_length_mm) += g.length;
        sum.link_length_mm += move.kind == MoveKind::kLink ? g.length : 0;
        if (g.length > 0) {
            const double feed = feed_of(path, move, at);
            stretches.push_back(
                stretch_of(g, feed > 0 ? feed / kSecondsPerMinute : kUnbounded, rates));
        }
        at = end_of(move);
    }
    sum.estimated_s = estimated_seconds(stretches, rates.exact_stop);
    sum.end = at;
    return sum;
}

}  // namespace cusp::toolpath
