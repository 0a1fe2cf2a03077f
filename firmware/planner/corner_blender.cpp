// Blends at corners of lines.
#include "firmware/planner/corner_blender.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/nurbs/arc_length_table.hpp"
#include "firmware/planner/speed_limit.hpp"
#include "firmware/planner/transition.hpp"

namespace cusp::planner {
namespace {

// A smaller change of direction is left to the axis filters: 0.5 degrees.
constexpr double kLeastTurn = 0.0087;
// Nearly a reversal: a blend would be all curvature. |t1 - t0| for 160 degrees.
constexpr double kGreatestTurn = 1.97;
// Shorter blends, mm, are slower than a stop.
constexpr double kShortestBlend = 1e-3;
// Part of each line that a blend may take.
constexpr double kShareOfLine = 0.45;
// Control points at -L, -L/2, 0, L/2 and L along the lines: the curve's middle is 3/16 L |t1 - t0|
// from the corner.
constexpr double kApex = 3.0 / 16.0;

// A blend must save this part of the time of a stop: acceleration around it takes longer.
constexpr float kWorthIt = 0.5F;

bool is_line(const path::Move& move) noexcept
{
    return std::holds_alternative<path::Line>(move.path);
}

bool may_blend(const path::Move& move) noexcept
{
    return move.tolerance > 0 && (is_line(move) || std::holds_alternative<path::Arc>(move.path));
}

}  // namespace

void CornerBlender::clear() noexcept
{
    held_.reset();
    made_.clear();
}

void CornerBlender::add(const path::Move& move, const Allowance& allowance) noexcept
{
    path::Move next = move;
    const Allowance both{allowance.jerk_time, std::min(held_departure_, allowance.departure)};
    if (held_ &&
        !(may_blend(move) && (blend(*held_, next, both.departure) || join(*held_, next, both)))) {
        (void)made_.try_push_back(*held_);
    }
    held_.reset();
    if (may_blend(next)) {
        held_ = next;
        held_departure_ = allowance.departure;
        release_front(*held_, allowance.departure);
    } else {
        release_last(next);
    }
}

// Releases all of a long move but the end that a blend may need, so that the tool need not slow down
// while the next move is not known.
void CornerBlender::release_front(path::Move& move, float departure) noexcept
{
    const double length = path::length(move);
    const double corner = 2.0 * static_cast<double>(departure) / (kApex * kLeastTurn);
    const double kept = std::max(corner, static_cast<double>(kLongestReach) / kShareOfLine);
    if (length < 2.0 * kept) {
        return;
    }
    release_last(take_front(move, length - kept));
}

// Behind what was made before.
void CornerBlender::release_last(const path::Move& move) noexcept
{
    (void)made_.try_push_back(move);
    for (std::size_t i = made_.size() - 1; i > 0; --i) {
        made_[i] = made_[i - 1];
    }
    made_[0] = move;
}

// Compares the time over the blend, and over the travel to which its speed is spread, with that of
// a stop.
bool CornerBlender::faster_than_stop(const path::BezierPiece& piece,
                                     float reach,
                                     float feed,
                                     float departure) const noexcept
{
    PathDerivatives bound{};
    for (const float u : {0.2F, 0.35F, 0.5F}) {
        const nurbs::CurveState state = nurbs::state_at(piece, u);
        bound = larger(
            bound, {magnitude(state.tangent), magnitude(state.curvature), magnitude(state.change)});
    }
    const float centripetal = shaper_square_ > 0 ? 2.0F * departure / shaper_square_ : kUnlimited;
    const float speed = std::sqrt(squared_cap(to_lanes(bound), limits_, centripetal, feed));
    const float travel = 2.0F * reach + speed * (ramp_time_ + 2.0F * shaper_length_);
    const float slowest = least(kUnlimited, limits_.acceleration);
    const float stop = ramp_time_ + shaper_length_ + 2.0F * std::sqrt(travel / slowest);
    return travel < kWorthIt * stop * speed;
}

// A transition where the curvature jumps. False where there is none.
bool CornerBlender::join(path::Move& before, path::Move& after, const Allowance& allowance) noexcept
{
    path::Move piece;
    if ((is_line(before) && is_line(after)) || before.power != after.power ||
        !make_transition(before, after, piece, limits_, allowance.jerk_time,
                         static_cast<double>(allowance.departure))) {
        return false;
    }
    piece.departure = allowance.departure;
    (void)made_.try_push_back(piece);
    (void)made_.try_push_back(before);
    return true;
}

// Shortens both lines and makes the curve between them. False where the corner stays.
bool CornerBlender::blend(path::Move& before, path::Move& after, float departure) noexcept
{
    if (!is_line(before) || !is_line(after) || before.power != after.power) {
        return false;
    }
    const AxisVecd first = to_millimetres(before.end - before.start);
    const AxisVecd second = to_millimetres(after.end - after.start);
    const double first_length = norm(first);
    const double second_length = norm(second);
    if (first_length <= 0 || second_length <= 0) {
        return false;
    }
    const AxisVecd t0 = first / first_length;
    const AxisVecd t1 = second / second_length;
    const double turn = norm(t1 - t0);
    if (turn < kLeastTurn || turn > kGreatestTurn) {
        return false;
    }
    const double reach = std::min({static_cast<double>(departure) / (kApex * turn),
                                   kShareOfLine * first_length, kShareOfLine * second_length});
    if (reach < kShortestBlend) {
        return false;
    }
    const Position corner = before.end;
    path::Move curve = after;
    curve.start = corner + to_position(t0 * -reach);
    curve.end = corner + to_position(t1 * reach);
    if (before.kind != after.kind) {
        const path::Move& fed = before.kind == path::MoveKind::kRapid ? after : before;
        curve.kind = fed.kind;
        curve.feed = fed.feed;
    } else {
        curve.feed = std::min(before.feed, after.feed);
    }
    path::BezierPiece piece{};
    piece.order = 5;
    const AxisVecd start = t0 * -reach;
    const AxisVecd points[] = {
        {}, t0 * (-0.5 * reach) - start, -start, t1 * (0.5 * reach) - start, t1 * reach - start};
    for (unsigned i = 0; i < 5; ++i) {
        piece.points[i] = to_float(points[i]);
        piece.weights[i] = 1.0F;
    }
    const bool rapid = curve.kind == path::MoveKind::kRapid;
    const float feed = rapid ? limits_.whole_velocity() : curve.feed;
    if (!faster_than_stop(piece, static_cast<float>(reach), feed, departure)) {
        return false;
    }
    curve.path = piece;
    before.end = curve.start;
    after.start = curve.end;
    (void)made_.try_push_back(curve);
    (void)made_.try_push_back(before);
    return true;
}

bool CornerBlender::next(bool ending, path::Move& move) noexcept
{
    if (!made_.empty()) {
        move = made_.back();
        made_.pop_back();
        return true;
    }
    if (ending && held_) {
        move = *held_;
        held_.reset();
        return true;
    }
    return false;
}

}  // namespace cusp::planner
