// Quintic pieces between lines and arcs.
#include "firmware/planner/transition.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "firmware/base/math.hpp"
#include "firmware/planner/quintic.hpp"
#include "firmware/planner/speed_limit.hpp"

namespace cusp::planner {
namespace {

// A greater change of direction is a corner: 0.5 degrees.
constexpr double kStraightTurn = 0.0087;
// The piece leaves the joint by this much of dK times the square of half its length.
constexpr double kDeviation = 0.01074;
// Most of a move that one transition takes, and of an arc, radians.
constexpr double kShareOfMove = 0.45;
constexpr double kGreatestAngle = 0.5;
// Its greatest third derivative, of dK over half its length; the jerk that its cap may take.
constexpr float kSlope = 1.125F / kTransitionJerkShare;

// The piece's parameter is arc length within this, relative: its feed is lower by as much.
constexpr float kFeedError = 2e-3F;

// A line or an arc by the length from its start.
class Curve {
public:
    explicit Curve(const path::Move& move) noexcept
        : arc_{std::get_if<path::Arc>(&move.path)},
          start_{to_millimetres(move.start)},
          length_{path::length(move)},
          along_{(to_millimetres(move.end) - start_) / length_}
    {
    }

    double length() const noexcept { return length_; }

    struct Place {
        AxisVecd at;  // mm, of the machine
        AxisVecd tangent;
        AxisVecd curvature;
    };
    Place at(double s) const noexcept
    {
        if (arc_ == nullptr) {
            return {start_ + along_ * s, along_, {}};
        }
        const double t = s / length_;
        const auto [sine, cosine] = sin_cos(t * arc_->sweep);
        const AxisVecd out = arc_->u * cosine + arc_->v * sine;
        const AxisVecd on = arc_->v * cosine - arc_->u * sine;
        const double radius = arc_->radius + t * arc_->radius_change;
        const double spread = arc_->radius_change / arc_->sweep;
        // By the angle.
        const AxisVecd slope = on * radius + out * spread + arc_->axial / arc_->sweep;
        const AxisVecd bend = on * (2 * spread) - out * radius;
        const double square = dot(slope, slope);
        const AxisVecd tangent = slope / std::sqrt(square);
        return {start_ + arc_->centre + out * radius + arc_->axial * t, tangent,
                (bend - tangent * dot(bend, tangent)) / square};
    }

    // Distance of a place from the curve, near the length s.
    double distance(AxisVecd place, double s) const noexcept
    {
        for (unsigned i = 0; i < 2; ++i) {
            const Place here = at(s);
            s = std::clamp(s + dot(place - here.at, here.tangent), 0.0, length_);
        }
        return norm(place - at(s).at);
    }

private:
    const path::Arc* arc_;
    AxisVecd start_;
    double length_;
    AxisVecd along_;
};

PathEnd end_of(const Curve::Place& place) noexcept
{
    return {to_float(place.tangent), to_float(place.curvature)};
}

bool may_join(const path::Move& move) noexcept
{
    return move.kind != path::MoveKind::kRapid && move.departure <= 0;
}

// Speed, squared, at which a jump of curvature takes all of the jerk.
float joint_speed(AxisVecf jump, const MachineLimits& limits, float jerk_time) noexcept
{
    float least = 1e12F;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        least = std::min(least, limits.jerk[i] * jerk_time / std::max(jump[i], 1e-12F));
    }
    return least;
}

// And at which a curvature takes all of the acceleration.
float bend_speed(AxisVecf curvature, const MachineLimits& limits) noexcept
{
    float least = 1e12F;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        least = std::min(least, limits.acceleration[i] / std::max(curvature[i], 1e-12F));
    }
    return least;
}

// Leaves the first `length` mm of a move.
void keep_front(path::Move& move, double length, Position end) noexcept
{
    if (auto* arc = std::get_if<path::Arc>(&move.path)) {
        const double part = length / path::length(move);
        arc->sweep *= part;
        arc->radius_change *= part;
        arc->axial = arc->axial * part;
    }
    move.end = end;
}

// Cuts off the first `length` mm of a move.
void cut_front(path::Move& move, double length, Position start) noexcept
{
    if (auto* arc = std::get_if<path::Arc>(&move.path)) {
        const double part = length / path::length(move);
        const auto [sine, cosine] = sin_cos(part * arc->sweep);
        const AxisVecd u = arc->u * cosine + arc->v * sine;
        arc->v = arc->v * cosine - arc->u * sine;
        arc->u = u;
        arc->centre = arc->centre + arc->axial * part - to_millimetres(start - move.start);
        arc->radius += part * arc->radius_change;
        arc->radius_change *= 1 - part;
        arc->axial = arc->axial * (1 - part);
        arc->sweep *= 1 - part;
    }
    move.start = start;
}

bool keeps_to(const path::Quintic& piece,
              Position from,
              AxisVecf chord,
              const Curve& before,
              const Curve& after,
              double deviation) noexcept
{
    constexpr unsigned kPlaces = 16;
    const AxisVecd start = to_millimetres(from);
    const LaneQuintic lanes = lane_quintic(piece.bulge, chord);
    const double half = 0.5 * static_cast<double>(piece.length);
    for (unsigned i = 1; i < kPlaces; ++i) {
        const double x = static_cast<double>(i) / kPlaces;
        const AxisVecf place = to_vec(point_at(lanes, static_cast<float>(x)));
        const AxisVecd at = start + to_double(place);
        const double s = (2 * x - 1) * half;
        const double off =
            std::min(before.distance(at, std::min(before.length() + s, before.length())),
                     after.distance(at, std::max(s, 0.0)));
        if (off > deviation) {
            return false;
        }
    }
    return true;
}

}  // namespace

path::Move take_front(path::Move& move, double length) noexcept
{
    const Position cut = to_position(Curve{move}.at(length).at);
    path::Move front = move;
    keep_front(front, length, cut);
    cut_front(move, length, cut);
    return front;
}

bool make_transition(path::Move& before,
                     path::Move& after,
                     path::Move& piece,
                     const MachineLimits& limits,
                     float jerk_time,
                     double deviation) noexcept
{
    if (!may_join(before) || !may_join(after)) {
        return false;
    }
    const Curve first{before};
    const Curve second{after};
    if (first.length() <= 0 || second.length() <= 0) {
        return false;
    }
    const Curve::Place end = first.at(first.length());
    const Curve::Place start = second.at(0);
    const AxisVecd jump = start.curvature - end.curvature;
    const double greatest = std::max(norm(start.curvature), norm(end.curvature));
    if (norm(start.tangent - end.tangent) > kStraightTurn || norm(jump) <= 0) {
        return false;
    }
    const float feed = std::min(before.feed, after.feed);
    const float square = joint_speed(magnitude(to_float(jump)), limits, jerk_time);
    const float bent = std::min(bend_speed(magnitude(to_float(start.curvature)), limits),
                                bend_speed(magnitude(to_float(end.curvature)), limits));
    if (square >= feed * feed || square >= bent) {
        return false;
    }
    const double least = static_cast<double>(kSlope * jerk_time * std::sqrt(square));
    double reach = std::min({std::sqrt(deviation / (kDeviation * norm(jump))),
                             kShareOfMove * first.length(), kShareOfMove * second.length(),
                             kGreatestAngle / greatest, static_cast<double>(kLongestReach)});
    constexpr double kShorter = 0.85;
    for (; reach > least; reach *= kShorter) {
        const Curve::Place from = first.at(first.length() - reach);
        const Curve::Place to = second.at(reach);
        const Position piece_start = to_position(from.at);
        const Position piece_end = to_position(to.at);
        const AxisVecf chord = to_float(to_millimetres(piece_end - piece_start));
        path::Quintic quintic{};
        if (!make_quintic(chord, end_of(from), end_of(to), kFeedError, quintic) ||
            !keeps_to(quintic, piece_start, chord, first, second, deviation)) {
            continue;
        }
        quintic.is_transition = true;
        piece = after;
        piece.path = quintic;
        piece.start = piece_start;
        piece.end = piece_end;
        piece.feed = feed * (1.0F - kFeedError);
        keep_front(before, first.length() - reach, piece_start);
        cut_front(after, reach, piece_end);
        return true;
    }
    return false;
}

}  // namespace cusp::planner
