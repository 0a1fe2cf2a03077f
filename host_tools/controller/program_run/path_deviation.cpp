// Nearest points of moves.
#include "host_tools/controller/program_run/path_deviation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::program_run {
namespace {

PathPlace nearest_on_segment(AxisVecd point, AxisVecd end, double length_squared)
{
    const double t =
        length_squared > 0 ? std::clamp(dot(point, end) / length_squared, 0.0, 1.0) : 0.0;
    return {norm(point - end * t), t};
}

// Point of the arc at t in [0, 1] and, by differences of the closed form, its derivatives.
struct ArcPoint {
    AxisVecd position;
    AxisVecd first;
    AxisVecd second;
};

ArcPoint arc_at(const path::Arc& arc, double t)
{
    const double angle = t * arc.sweep;
    const double radius = arc.radius + t * arc.radius_change;
    const AxisVecd out = arc.u * elementary::cos(angle) + arc.v * elementary::sin(angle);
    const AxisVecd along = arc.v * elementary::cos(angle) - arc.u * elementary::sin(angle);
    return {arc.centre + out * radius + arc.axial * t,
            out * arc.radius_change + along * (radius * arc.sweep) + arc.axial,
            along * (2.0 * arc.radius_change * arc.sweep) - out * (radius * arc.sweep * arc.sweep)};
}

PathPlace nearest_on_arc_from(const path::Arc& arc, AxisVecd point, double t)
{
    for (int iteration = 0; iteration < 12; ++iteration) {
        const ArcPoint at = arc_at(arc, t);
        const AxisVecd away = at.position - point;
        const double slope = dot(away, at.first);
        const double curvature = dot(at.first, at.first) + dot(away, at.second);
        // Far from the arc Newton's method diverges: a step of steepest descent replaces it.
        const double step = slope / (curvature > 0 ? curvature : dot(at.first, at.first));
        const double next = std::clamp(t - step, 0.0, 1.0);
        if (std::fabs(next - t) < 1e-13) {
            break;
        }
        t = next;
    }
    return {norm(arc_at(arc, t).position - point), t};
}

PathPlace nearest_on_arc(const path::Arc& arc, AxisVecd point)
{
    const AxisVecd from_centre = point - arc.centre;
    double angle = elementary::atan2(dot(from_centre, arc.v), dot(from_centre, arc.u));
    if (angle < 0) {
        angle += 2.0 * kPi;
    }
    PathPlace nearest{norm(arc_at(arc, 0.0).position - point), 0.0};
    const PathPlace at_end{norm(arc_at(arc, 1.0).position - point), 1.0};
    if (at_end.distance < nearest.distance) {
        nearest = at_end;
    }
    // The turn whose height and radius are nearest to the point's.
    const double outwards = elementary::hypot(dot(from_centre, arc.u), dot(from_centre, arc.v));
    const double change = dot(arc.axial, arc.axial) + arc.radius_change * arc.radius_change;
    const double nearest_t =
        change > 0
            ? (dot(from_centre, arc.axial) + (outwards - arc.radius) * arc.radius_change) / change
            : 0.0;
    const double turns = std::ceil(arc.sweep / (2.0 * kPi));
    const double middle =
        std::clamp(std::floor(nearest_t * arc.sweep / (2.0 * kPi)), 0.0, turns - 1.0);
    // If radius or height change, the nearest place is turned away from the point's own angle, and
    // may lie on the arc where that angle is beyond its end: by up to a quarter turn it counts.
    const double quarter = 0.5 * kPi / arc.sweep;
    for (double turn = middle - 1.0; turn <= middle + 1.0; ++turn) {
        const double t = (angle + turn * 2.0 * kPi) / arc.sweep;
        if (t >= -quarter && t <= 1.0 + quarter) {
            const PathPlace found = nearest_on_arc_from(arc, point, std::clamp(t, 0.0, 1.0));
            if (found.distance < nearest.distance) {
                nearest = found;
            }
        }
    }
    return nearest;
}

// De Casteljau in homogeneous coordinates.
AxisVecd bezier_at(const path::BezierPiece& piece, double t)
{
    std::array<AxisVecd, path::kMaxOrder> points{};
    std::array<double, path::kMaxOrder> weights{};
    for (unsigned i = 0; i < piece.order; ++i) {
        weights[i] = static_cast<double>(piece.weights[i]);
        const AxisVecf& p = piece.points[i];
        points[i] = to_double(p) * weights[i];
    }
    for (unsigned left = piece.order; left > 1; --left) {
        for (unsigned i = 0; i + 1 < left; ++i) {
            points[i] = points[i] * (1.0 - t) + points[i + 1] * t;
            weights[i] = weights[i] * (1.0 - t) + weights[i + 1] * t;
        }
    }
    return points[0] / weights[0];
}

PathPlace nearest_on_bezier(const path::BezierPiece& piece, AxisVecd point)
{
    constexpr int kSamples = 32;
    const auto distance_at = [&](double t) {
        return norm(bezier_at(piece, t) - point);
    };
    int best = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= kSamples; ++i) {
        const double distance = distance_at(static_cast<double>(i) / kSamples);
        if (distance < nearest) {
            nearest = distance;
            best = i;
        }
    }
    // Golden section between the neighbours of the nearest sample.
    constexpr double kGolden = 0.6180339887498949;
    double low = std::max(0, best - 1) / static_cast<double>(kSamples);
    double high = std::min(kSamples, best + 1) / static_cast<double>(kSamples);
    while (high - low > 1e-9) {
        const double a = high - (high - low) * kGolden;
        const double b = low + (high - low) * kGolden;
        (distance_at(a) < distance_at(b) ? high : low) = distance_at(a) < distance_at(b) ? b : a;
    }
    const double middle = (low + high) / 2;
    if (distance_at(middle) < nearest) {
        return {distance_at(middle), middle};
    }
    return {nearest, static_cast<double>(best) / kSamples};
}

// Among equally near moves the latest counts.
constexpr double kTie = 1e-7;

}  // namespace

PathPlace nearest_place(const path::Move& move, Position point)
{
    const AxisVecd relative = to_millimetres(point - move.start);
    if (const auto* arc = std::get_if<path::Arc>(&move.path)) {
        return nearest_on_arc(*arc, relative);
    }
    if (const auto* piece = std::get_if<path::BezierPiece>(&move.path)) {
        return nearest_on_bezier(*piece, relative);
    }
    const AxisVecd chord = to_millimetres(move.end - move.start);
    return nearest_on_segment(relative, chord, dot(chord, chord));
}

void PathDeviation::add_move(const path::Move& move)
{
    const double length = path::length(move);
    if (length <= 0.0) {
        return;
    }
    const auto* arc = std::get_if<path::Arc>(&move.path);
    if (arc != nullptr && arc->sweep > 2.0 * kPi) {
        add_turns(move, *arc);
    } else {
        add_stretch(move, length);
    }
    greatest_tolerance_ = std::max(greatest_tolerance_, static_cast<double>(move.tolerance));
}

void PathDeviation::add_stretch(const path::Move& move, double length)
{
    const AxisVecd chord = to_millimetres(move.end - move.start);
    const bool straight = std::holds_alternative<path::Line>(move.path);
    stretches_.push_back({move, end_, end_ + length, straight, chord, dot(chord, chord)});
    end_ += length;
}

// The turns of a flat arc lie on each other: half turns tell by the length travelled which one it is.
void PathDeviation::add_turns(const path::Move& move, const path::Arc& arc)
{
    const auto parts = static_cast<int>(std::ceil(arc.sweep / kPi));
    for (int i = 0; i < parts; ++i) {
        const double begin = static_cast<double>(i) / parts;
        const double turned = begin * arc.sweep;
        path::Arc part = arc;
        part.centre = arc.centre + arc.axial * begin;
        part.u = arc.u * elementary::cos(turned) + arc.v * elementary::sin(turned);
        part.v = arc.v * elementary::cos(turned) - arc.u * elementary::sin(turned);
        part.axial = arc.axial / parts;
        part.radius = arc.radius + begin * arc.radius_change;
        part.radius_change = arc.radius_change / parts;
        part.sweep = arc.sweep / parts;
        path::Move half = move;
        half.path = part;
        add_stretch(half, path::length(half));
    }
}

void PathDeviation::restart()
{
    stretches_.clear();
    first_near_ = 0;
    place_ = end_;
}

// Upper bound of the movement along the path since the last set point: the distance travelled plus
// the length that blending cuts off at a corner.
double PathDeviation::reach(Position set_point) const
{
    constexpr double kSlack = 0.5;
    constexpr double kMostTravel = 2.0;  // in one tick, at 120 m/min
    const double travel = std::min(kMostTravel, norm(to_millimetres(set_point - last_)));
    return kSlack + 2.0 * travel + 8.0 * greatest_tolerance_;
}

PathPlace PathDeviation::nearest_on(const Stretch& stretch, Position point)
{
    if (!stretch.straight) {
        return nearest_place(stretch.move, point);
    }
    return nearest_on_segment(to_millimetres(point - stretch.move.start), stretch.chord,
                              stretch.chord_square);
}

// Ends of stretches ascend. A set point passes few of them.
void PathDeviation::find_first_near(double place)
{
    while (first_near_ > 0 && stretches_[first_near_ - 1].end >= place) {
        --first_near_;
    }
    while (first_near_ < stretches_.size() && stretches_[first_near_].end < place) {
        ++first_near_;
    }
}

double PathDeviation::add_set_point(Position set_point)
{
    if (stretches_.empty() || set_point == last_) {
        last_ = set_point;
        return 0;
    }
    const double around = reach(set_point);
    last_ = set_point;
    double nearest = std::numeric_limits<double>::infinity();
    double place = place_;
    std::uint32_t line = 0;
    find_first_near(place_ - around);
    for (std::size_t k = first_near_; k < stretches_.size(); ++k) {
        const Stretch& stretch = stretches_[k];
        if (stretch.start > place_ + around) {
            break;
        }
        const PathPlace found = nearest_on(stretch, set_point);
        if (found.distance <= nearest + kTie) {
            nearest = std::min(nearest, found.distance);
            place = stretch.start + found.part * (stretch.end - stretch.start);
            line = stretch.move.line;
        }
    }
    place_ = place;
    while (stretches_.size() > 1 && stretches_.front().end < place_ - 4.0 * around) {
        stretches_.pop_front();
        first_near_ = first_near_ > 0 ? first_near_ - 1 : 0;
    }
    if (nearest == std::numeric_limits<double>::infinity()) {
        return 0;
    }
    if (nearest > greatest_) {
        greatest_ = nearest;
        line_ = line;
    }
    return nearest;
}

}  // namespace cusp::program_run
