// Biarcs through the vertices of dense lines.
#include "firmware/planner/line_smoother.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/assert.hpp"
#include "firmware/base/math.hpp"

namespace cusp::planner {
namespace {

// A vertex that turns by more than this is a corner: 20 degrees.
constexpr float kCornerTurnSquared = 0.1206F;  // (2 sin 10 degrees)^2
// Flatter than this, in mm of height over the chord, an arc is a line.
constexpr float kFlat = 2e-6F;
// Neighbours at least this far away give a tangent that rounded decimals hardly turn, mm.
constexpr float kTangentSpan = 0.2F;
// The jumps of curvature between arcs grow with their length. Much shorter than the travel in one
// window of the axis filters, 1.2 mm at 100 mm/s, they gain nothing.
constexpr float kLongestBiarc = 2.0F;  // mm

// For distances below 2 m: the target converts 32 bits in one instruction.
Vec3f millimetres(Position p) noexcept
{
    constexpr float kScale = 1e-6F;
    const auto scaled = [](std::int64_t nm) {
        return static_cast<float>(static_cast<std::int32_t>(nm)) * kScale;
    };
    return {scaled(p.x), scaled(p.y), scaled(p.z)};
}

bool is_short(Position p) noexcept
{
    constexpr auto kLongest = static_cast<std::int64_t>(LineSmoother::kLongestLine * 1e6F);
    for (unsigned i = 0; i < 3; ++i) {
        if (p[i] > kLongest || p[i] < -kLongest) {
            return false;
        }
    }
    return true;
}

Vec3d to_double(Vec3f a) noexcept
{
    return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

Vec3f unit(Vec3f a) noexcept
{
    const float length = norm(a);
    return length > 0 ? a / length : a;
}

}  // namespace

bool LineSmoother::accepts(const path::Move& move) noexcept
{
    if (move.kind != path::MoveKind::kFeed || move.tolerance <= 0 ||
        !std::holds_alternative<path::Line>(move.path) || move.start == move.end ||
        !is_short(move.end - move.start)) {
        return false;
    }
    const Vec3f along = millimetres(move.end - move.start);
    return dot(along, along) <= kLongestLine * kLongestLine;
}

bool LineSmoother::continues(const path::Move& move) const noexcept
{
    const std::size_t count = vertices_.size();
    if (count < 2) {
        return true;
    }
    if (move.feed != model_.feed || move.tolerance != model_.tolerance ||
        vertices_[count - 1].at != move.start) {
        return false;
    }
    const Vec3f before = unit(millimetres(vertices_[count - 1].at - vertices_[count - 2].at));
    const Vec3f turn = unit(millimetres(move.end - move.start)) - before;
    return dot(turn, turn) <= kCornerTurnSquared;
}

void LineSmoother::add(const path::Move& move) noexcept
{
    if (vertices_.empty()) {
        model_ = move;
        at_ = move.start;
        has_tangent_ = false;
        (void)vertices_.try_push_back({move.start, move.line});
    }
    const bool added = vertices_.try_push_back({move.end, move.line});
    CUSP_ASSERT(added);
}

void LineSmoother::clear() noexcept
{
    vertices_.clear();
    has_tangent_ = false;
    has_second_ = false;
}

Vec3f LineSmoother::place(std::size_t index) const noexcept
{
    return millimetres(vertices_[index].at - vertices_[0].at);
}

// Tangent of the parabola through the vertex and a neighbour on either side; at the ends of the
// run, of the parabola through the three last.
Vec3f LineSmoother::tangent_at(std::size_t index) const noexcept
{
    const std::size_t count = vertices_.size();
    const Vec3f here = place(index);
    std::size_t before = index;
    std::size_t after = index;
    while (before > 0 && index - before < kBeyond && norm(place(before) - here) < kTangentSpan) {
        --before;
    }
    while (after + 1 < count && after - index < kBeyond &&
           norm(place(after) - here) < kTangentSpan) {
        ++after;
    }
    if (before == index || after == index) {
        const bool at_start = before == index;
        const std::size_t middle = at_start ? after : before;
        const std::size_t far = at_start ? std::min(2 * after - index, count - 1)
                                         : (2 * before >= index ? 2 * before - index : 0);
        const Vec3f chord = place(middle) - here;
        const float length = norm(chord);
        const Vec3f beyond = place(far) - place(middle);
        const float rest = norm(beyond);
        Vec3f slope = chord / length;
        if (rest > 0) {
            slope = slope + (slope - beyond / rest) * (length / (length + rest));
        }
        return unit(at_start ? slope : -slope);
    }
    const Vec3f back = here - place(before);
    const Vec3f ahead = place(after) - here;
    const float first = norm(back);
    const float second = norm(ahead);
    return unit(back * (second / first) + ahead * (first / second));
}

LineSmoother::Arc LineSmoother::tangent_arc(Vec3f start, Vec3f tangent, Vec3f end) noexcept
{
    const Vec3f chord = end - start;
    const float along = dot(chord, tangent);
    const Vec3f across = chord - tangent * along;
    const float height = norm(across);
    Arc arc{start, end, tangent, {}, 0};
    if (height < kFlat || along <= 0) {
        return arc;
    }
    arc.normal = across / height;
    arc.radius = dot(chord, chord) / (2.0F * height);
    return arc;
}

float LineSmoother::distance(const Arc& arc, Vec3f point) noexcept
{
    const Vec3f from = point - arc.start;
    if (arc.radius <= 0) {
        const Vec3f direction = unit(arc.end - arc.start);
        return norm(from - direction * dot(from, direction));
    }
    // In the arc's plane: t along the tangent, n towards the centre; the rest is out of it.
    const float t = dot(from, arc.tangent);
    const float n = dot(from, arc.normal);
    const Vec3f off = from - arc.tangent * t - arc.normal * n;
    // |sqrt(t^2 + (r - n)^2) - r| without cancellation.
    const float square = t * t + n * n - 2.0F * arc.radius * n;
    const float radial = square / (std::sqrt(arc.radius * arc.radius + square) + arc.radius);
    return std::sqrt(radial * radial + dot(off, off));
}

bool LineSmoother::within_tolerance(const Biarc& biarc, std::size_t last) const noexcept
{
    const float tolerance = kShareOfTolerance * model_.tolerance;
    const Vec3f joint = biarc.first.end;
    const Vec3f direction = unit(biarc.second.end - biarc.first.start);
    Vec3f before = place(0);
    for (std::size_t i = 1; i <= last; ++i) {
        const Vec3f here = place(i);
        for (const Vec3f point : {(before + here) * 0.5F, here}) {
            const bool first = dot(point - joint, direction) < 0;
            if (distance(first ? biarc.first : biarc.second, point) > tolerance) {
                return false;
            }
        }
        before = here;
    }
    return true;
}

bool LineSmoother::fit(std::size_t last, Biarc& biarc) const noexcept
{
    const Vec3f t0 = has_tangent_ ? tangent_ : tangent_at(0);
    const Vec3f t1 = tangent_at(last);
    const Vec3f chord = place(last);
    // Equal control lengths d: chord^2 - 2 d chord.(t0 + t1) - 2 d^2 (1 - t0.t1) = 0.
    const Vec3f difference = t1 - t0;
    const float bend = dot(difference, difference);  // 2 (1 - t0.t1)
    const float along = dot(chord, t0 + t1);
    const float square = dot(chord, chord);
    if (along <= 0 || (last > 2 && square > kLongestBiarc * kLongestBiarc)) {
        return false;
    }
    const float d = square / (along + std::sqrt(along * along + bend * square));
    const Vec3f joint = (t0 * d + (chord - t1 * d)) * 0.5F;
    biarc.first = tangent_arc({}, t0, joint);
    biarc.second = tangent_arc(joint, unit(chord - t1 * d - t0 * d), chord);
    return within_tolerance(biarc, last);
}

path::Move LineSmoother::as_move(const Arc& arc, Position end) const noexcept
{
    path::Move move = model_;
    move.departure = kShareOfTolerance * model_.tolerance;
    move.start = at_;
    move.end = end;
    move.path = path::Line{};
    if (arc.radius > 0) {
        path::Arc shape{};
        const Vec3d normal = to_double(arc.normal);
        shape.radius = static_cast<double>(arc.radius);
        shape.centre = normal * shape.radius;
        shape.u = -normal;
        shape.v = to_double(arc.tangent);
        // The height over the tangent from the radius: a product with the normal would have the
        // rounding of the whole chord.
        const Vec3f chord = arc.end - arc.start;
        const float height = dot(chord, chord) / (2.0F * arc.radius);
        shape.sweep =
            2.0 * atan2(static_cast<double>(height), static_cast<double>(dot(chord, arc.tangent)));
        move.path = shape;
    }
    return move;
}

bool LineSmoother::next(Patience patience, path::Move& piece) noexcept
{
    const bool ending = patience == Patience::kNone;
    if (has_second_) {
        piece = second_;
        at_ = piece.end;
        has_second_ = false;
        return true;
    }
    const std::size_t lines = vertices_.empty() ? 0 : vertices_.size() - 1;
    const bool waits = patience == Patience::kShort ? lines <= kBeyond : !vertices_.full();
    if (lines == 0 || (!ending && waits)) {
        if (ending) {
            vertices_.clear();
        }
        return false;
    }
    const std::size_t most =
        ending ? std::min(lines, kMostLines) : std::min(lines - kBeyond, kMostLines);
    // The longest that fits, by doubling and then halving the step.
    std::size_t good = 0;
    Biarc best{};
    Biarc tried{};
    std::size_t step = 1;
    while (good + step <= most && fit(good + step, tried)) {
        good += step;
        best = tried;
        step *= 2;
    }
    for (step /= 2; step > 0; step /= 2) {
        if (good + step <= most && fit(good + step, tried)) {
            good += step;
            best = tried;
        }
    }
    // The number of the first line: a reported line is never ahead of the tool.
    model_.line = vertices_[1].line;
    if (good == 0) {
        // Not even one line can be rounded: it stays, and its ends are corners.
        piece = as_move(Arc{}, vertices_[1].at);
        at_ = piece.end;
        has_tangent_ = false;
        drop(1);
        return true;
    }
    const Position middle = vertices_[0].at + to_position(to_double(best.first.end));
    const Vec3f end_tangent = tangent_at(good);
    piece = as_move(best.first, middle);
    at_ = middle;
    second_ = as_move(best.second, vertices_[good].at);
    has_second_ = true;
    tangent_ = end_tangent;
    has_tangent_ = true;
    drop(good);
    return true;
}

void LineSmoother::drop(std::size_t count) noexcept
{
    const std::size_t left = vertices_.size() - count;
    for (std::size_t i = 0; i < left; ++i) {
        vertices_[i] = vertices_[i + count];
    }
    while (vertices_.size() > left) {
        vertices_.pop_back();
    }
}

}  // namespace cusp::planner
