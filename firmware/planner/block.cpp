// Lines and arcs as the servo tick sees them.
#include "firmware/planner/block.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/assert.hpp"
#include "firmware/base/lane_vec.hpp"
#include "firmware/base/math.hpp"
#include "firmware/planner/quintic.hpp"

namespace cusp::planner {
namespace {

constexpr unsigned kStretchesPerQuadrant = 24;
constexpr unsigned kStretchesPerTableInterval = 4;
constexpr unsigned kStretchesPerQuintic = 8;
constexpr float kHalfTick = 0.5F * kServoTick;

float length_mm(const Block& block) noexcept
{
    return static_cast<float>(block.length) / kPathUnitsPerMillimetre;
}

AxisVecf displacement_mm(const Block& block) noexcept
{
    return to_float(block.displacement) / kPathUnitsPerMillimetre;
}

// To the nearest integer. Precondition: |x| < 2^31.
std::int32_t rounded(float x) noexcept
{
    return static_cast<std::int32_t>(x + (x < 0 ? -0.5F : 0.5F));
}

PathOffset rounded(const AxisVecf& v) noexcept
{
    return mapped(v, [](float x) { return rounded(x); });
}

PathOffset arc_position(const ArcBlock& arc, std::uint32_t offset) noexcept
{
    const float angle = static_cast<float>(offset) * arc.angle_per_unit;
    // Half angles keep 1 - cos exact for small angles.
    const float half = 0.5F * angle;
    const auto [sine, cosine] =
        quarter_turns(half) < 1.0F ? sin_cos_near_zero(half) : sin_cos(half);
    const float along = 2.0F * sine * cosine;
    const float inward = 2.0F * sine * sine;
    const float grown = arc.spread * angle;
    const AxisVecf place = arc.tangent * ((arc.radius + grown) * along) +
                           arc.normal * (arc.radius * inward - grown * (1.0F - inward)) +
                           arc.axial * angle;
    return rounded(place * kPathUnitsPerMillimetre);
}

// Unit vectors of an arc turned by `angle`.
struct ArcFrame {
    AxisVecf tangent;
    AxisVecf normal;
};

ArcFrame frame_at(const ArcBlock& arc, float angle) noexcept
{
    const auto [sine, cosine] = sin_cos(angle);
    return {arc.tangent * cosine + arc.normal * sine, arc.normal * cosine - arc.tangent * sine};
}

float radians_per_mm(const ArcBlock& arc) noexcept
{
    return arc.angle_per_unit * kPathUnitsPerMillimetre;
}

// By arc length, with signs. By the angle the frame turns as T' = N, N' = -T.
LaneDerivatives arc_state(const ArcBlock& arc, float angle) noexcept
{
    const ArcFrame frame = frame_at(arc, angle);
    const float rate = radians_per_mm(arc);
    const float radius = arc.radius + arc.spread * angle;
    const AxisVecf first = frame.tangent * radius - frame.normal * arc.spread + arc.axial;
    const AxisVecf second = frame.normal * radius + frame.tangent * (2.0F * arc.spread);
    const AxisVecf third = frame.normal * (3.0F * arc.spread) - frame.tangent * radius;
    return {to_lanes(first * rate), to_lanes(second * (rate * rate)),
            to_lanes(third * (rate * rate * rate))};
}

EndGeometry arc_geometry(const ArcBlock& arc, float angle) noexcept
{
    const LaneDerivatives state = arc_state(arc, angle);
    return {to_vec(state.first), to_vec(state.second)};
}

// Largest |a cos h + b sin h| over h between two angles at most pi/2 apart.
float largest_turned(float a, float b, SinCos<float> from, SinCos<float> to) noexcept
{
    const float ends =
        std::max(std::fabs(a * from.cos + b * from.sin), std::fabs(a * to.cos + b * to.sin));
    const float slope0 = b * from.cos - a * from.sin;
    const float slope1 = b * to.cos - a * to.sin;
    const bool peak_inside = (slope0 > 0) != (slope1 > 0);
    return peak_inside ? std::sqrt(a * a + b * b) : ends;
}

// Between two angles, the second of which is `to_angle`.
PathDerivatives arc_derivatives(const ArcBlock& arc,
                                SinCos<float> from,
                                SinCos<float> to,
                                float to_angle) noexcept
{
    const float rate = radians_per_mm(arc);
    const float widest = arc.radius + std::max(0.0F, arc.spread * to_angle);
    const float spread = std::fabs(arc.spread);
    PathDerivatives bound{};
    for (unsigned i = 0; i < kAxisCount; ++i) {
        const float tangent = arc.tangent[i];
        const float normal = arc.normal[i];
        const float along = largest_turned(tangent, normal, from, to);
        const float inward = largest_turned(normal, -tangent, from, to);
        bound.first[i] = (widest * along + spread * inward + std::fabs(arc.axial[i])) * rate;
        bound.second[i] = (widest * inward + 2.0F * spread * along) * rate * rate;
        bound.third[i] = (widest * along + 3.0F * spread * inward) * rate * rate * rate;
    }
    return bound;
}

PathOffset curve_position(CurveBlock& curve, std::uint32_t offset) noexcept
{
    const float s = static_cast<float>(offset) / kPathUnitsPerMillimetre;
    const AxisVecf place =
        nurbs::point_at(curve.piece, nurbs::parameter_at(curve.table, s, curve.table.last_found));
    return rounded(place * kPathUnitsPerMillimetre);
}

LaneVec largest(LaneVec a, LaneVec m, LaneVec b) noexcept
{
    return larger(larger(magnitude(a), magnitude(m)), magnitude(b));
}

// Bound of |f| between two places from both and the middle, with a part of their second difference.
LaneVec largest_of(LaneVec at_a, LaneVec at_m, LaneVec at_b, float part) noexcept
{
    const LaneVec bend = magnitude(at_a - at_m * 2.0F + at_b);
    return largest(at_a, at_m, at_b) + bend * part;
}

// Bound of |f|, with `change` a bound of its second derivative: between places h apart a function
// exceeds the larger of both by at most h^2/8 of that.
LaneVec largest_of_slow(
    LaneVec at_a, LaneVec at_m, LaneVec at_b, LaneVec change, float length) noexcept
{
    return largest(at_a, at_m, at_b) + change * (0.03125F * length * length);
}

// By arc length, with signs.
LaneDerivatives curve_state(const CurveBlock& curve, float u) noexcept
{
    const nurbs::CurveState state = nurbs::state_at(curve.piece, u);
    return to_lanes(PathDerivatives{state.tangent, state.curvature, state.change});
}

// Bounds over a stretch, `length` mm long, from both ends and the middle.
LaneDerivatives curve_derivatives(const LaneDerivatives& a,
                                  const LaneDerivatives& m,
                                  const LaneDerivatives& b,
                                  float length) noexcept
{
    // A parabola through three places exceeds the greatest of them by at most an eighth of their
    // second difference. Twice that bounds other functions:
    // tests/unit/planner/stretch_test.cpp.
    const LaneVec second = largest_of(a.second, m.second, b.second, 0.25F);
    const LaneVec third = largest_of(a.third, m.third, b.third, 0.25F);
    return {largest_of_slow(a.first, m.first, b.first, third, length), second, third};
}

// Start of the stretch `index` of a curve.
struct CurvePlace {
    float s;
    float u;
};

CurvePlace curve_place(const CurveBlock& curve, unsigned index) noexcept
{
    auto interval = static_cast<std::uint8_t>(index / kStretchesPerTableInterval);
    const nurbs::ArcLengthNode& node = curve.table.nodes[interval];
    const unsigned part = index % kStretchesPerTableInterval;
    if (part == 0) {
        return {node.s, node.u};
    }
    const float length = curve.table.nodes[interval + 1U].s - node.s;
    const float s = node.s + length * (static_cast<float>(part) /
                                       static_cast<float>(kStretchesPerTableInterval));
    return {s, nurbs::parameter_at(curve.table, s, interval)};
}

EndGeometry curve_geometry(const CurveBlock& curve, float u) noexcept
{
    const nurbs::CurveState state = nurbs::state_at(curve.piece, u);
    return {state.tangent, state.curvature};
}

PathOffset quintic_position(const Block& block, std::uint32_t offset) noexcept
{
    const float x = static_cast<float>(fraction(block, offset)) * 0x1p-31F;
    const auto& q = block.quintic.bulge;
    const float scale = x * (1.0F - x) * kPathUnitsPerMillimetre;
    const AxisVecf bulge = (q[0] + (q[1] + (q[2] + q[3] * x) * x) * x) * scale;
    return line_position(block, offset) + rounded(bulge);
}

// A quintic ready to be asked for the derivatives of several places.
struct QuinticFrame {
    LaneQuintic piece;
    float inverse;  // of the length
};

QuinticFrame quintic_frame(const Block& block) noexcept
{
    return {lane_quintic(block.quintic.bulge, displacement_mm(block)), 1.0F / length_mm(block)};
}

// The first three derivatives by arc length.
LaneDerivatives quintic_state(const QuinticFrame& frame, float x) noexcept
{
    const auto& [b0, b1, b2, b3] = frame.piece.bulge;
    // Q and its derivatives, then those of x (1 - x) Q.
    const LaneVec q0 = b0 + (b1 + (b2 + b3 * x) * x) * x;
    const LaneVec q1 = b1 + (b2 * 2.0F + b3 * (3.0F * x)) * x;
    const LaneVec q2 = b2 * 2.0F + b3 * (6.0F * x);
    const float bump = x * (1.0F - x);
    const float slope = 1.0F - 2.0F * x;
    const float square = frame.inverse * frame.inverse;
    return {(frame.piece.chord + q0 * slope + q1 * bump) * frame.inverse,
            (q0 * -2.0F + q1 * (2.0F * slope) + q2 * bump) * square,
            (q1 * -6.0F + q2 * (3.0F * slope) + b3 * (6.0F * bump)) * (square * frame.inverse)};
}

// Bounds over a stretch, `length` mm long, from both ends and the middle.
// The third derivative is a parabola. The second is a cubic: it leaves the parabola through three
// places by at most 1/(9 sqrt(3)) of its third derivative times the cube of half the length.
LaneDerivatives quintic_derivatives(const LaneDerivatives& a,
                                    const LaneDerivatives& m,
                                    const LaneDerivatives& b,
                                    float length) noexcept
{
    const LaneVec bend = magnitude(a.third - m.third * 2.0F + b.third);
    const LaneVec third = largest(a.third, m.third, b.third) + bend * 0.125F;
    const LaneVec second =
        largest_of(a.second, m.second, b.second, 0.125F) + bend * (0.0321F * length);
    return {largest_of_slow(a.first, m.first, b.first, third, length), second, third};
}

EndGeometry quintic_geometry(const Block& block, float x) noexcept
{
    const LaneDerivatives state = quintic_state(quintic_frame(block), x);
    return {to_vec(state.first), to_vec(state.second)};
}

PathDerivatives line_derivatives(const Block& block) noexcept
{
    return {magnitude(displacement_mm(block) / length_mm(block)), {}, {}};
}

float sweep(const Block& block) noexcept
{
    return static_cast<float>(block.length) * block.arc.angle_per_unit;
}

}  // namespace

void set_length(Block& block, std::uint32_t length) noexcept
{
    CUSP_ASSERT(length > 0);
    block.length = length;
    // The reciprocal has its top bit set: 2^(32 + shift) / length in (2^31, 2^32].
    std::uint8_t shift = 0;
    while (shift < 31 && (std::uint32_t{2} << shift) <= length) {
        ++shift;
    }
    const std::uint64_t scaled = std::uint64_t{1} << (32U + shift);
    block.reciprocal =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(scaled / length, 0xFFFFFFFFU));
    block.reciprocal_shift = shift;
}

PathOffset curved_position(const Block& block, std::uint32_t offset) noexcept
{
    switch (block.shape) {
        case BlockShape::kArc:
            return arc_position(block.arc, offset);
        case BlockShape::kCurve:
            return curve_position(*block.curve, offset);
        case BlockShape::kQuintic:
            return quintic_position(block, offset);
        case BlockShape::kLine:
            break;
    }
    return line_position(block, offset);
}

EndGeometry start_geometry(const Block& block) noexcept
{
    switch (block.shape) {
        case BlockShape::kArc:
            return arc_geometry(block.arc, 0.0F);
        case BlockShape::kCurve:
            return curve_geometry(*block.curve, 0.0F);
        case BlockShape::kQuintic:
            return quintic_geometry(block, 0.0F);
        case BlockShape::kLine:
            break;
    }
    return {displacement_mm(block) / length_mm(block), {}};
}

EndGeometry end_geometry(const Block& block) noexcept
{
    switch (block.shape) {
        case BlockShape::kArc:
            return arc_geometry(block.arc, sweep(block));
        case BlockShape::kCurve:
            return curve_geometry(*block.curve, 1.0F);
        case BlockShape::kQuintic:
            return quintic_geometry(block, 1.0F);
        case BlockShape::kLine:
            break;
    }
    return start_geometry(block);
}

bool is_within_half_tick(const Block& block, float speed) noexcept
{
    return static_cast<float>(block.length) < kHalfTick * kPathUnitsPerMillimetre * speed;
}

AxisVecf felt_end(const Block& block, AxisVecf start, AxisVecf end) noexcept
{
    const float length = static_cast<float>(block.length) / kPathUnitsPerMillimetre;
    // It bends by its turn over its length: the speed of that is the root of centripetal length / turn.
    const bool at_once = length * norm(end - start) < kHalfTick * kHalfTick * block.centripetal;
    return at_once ? start : end;
}

LaneDerivatives derivatives_at(const Block& block, float s) noexcept
{
    switch (block.shape) {
        case BlockShape::kArc:
            return arc_state(block.arc, s * radians_per_mm(block.arc));
        case BlockShape::kCurve: {
            std::uint8_t interval = block.curve->table.size / 2U;
            return curve_state(*block.curve, nurbs::parameter_at(block.curve->table, s, interval));
        }
        case BlockShape::kQuintic: {
            const QuinticFrame frame = quintic_frame(block);
            return quintic_state(frame, s * frame.inverse);
        }
        case BlockShape::kLine:
            break;
    }
    const LaneVec none = all_lanes(0.0F);
    return {to_lanes(displacement_mm(block) / length_mm(block)), none, none};
}

unsigned stretch_count(const Block& block) noexcept
{
    if (block.shape == BlockShape::kCurve) {
        return (block.curve->table.size - 1U) * kStretchesPerTableInterval;
    }
    if (block.shape == BlockShape::kLine) {
        return 1;
    }
    if (block.shape == BlockShape::kQuintic) {
        return kStretchesPerQuintic;
    }
    const float quadrants = sweep(block) * static_cast<float>(2.0 / kPi);
    return 1U + static_cast<unsigned>(quadrants * static_cast<float>(kStretchesPerQuadrant));
}

StretchReader::StretchReader(const Block& block, unsigned index) noexcept
    : block_{block}, next_{index}, count_{stretch_count(block)}, begin_{place_at(index)}
{
    if (block.shape == BlockShape::kQuintic) {
        begin_.state = quintic_state(quintic_frame(block), begin_.part);
    }
}

StretchReader::Place StretchReader::place_at(unsigned index) const noexcept
{
    Place place{};
    if (block_.shape == BlockShape::kLine) {
        return place;
    }
    if (block_.shape == BlockShape::kCurve) {
        const CurvePlace on_curve = curve_place(*block_.curve, index);
        place.s = on_curve.s;
        place.u = on_curve.u;
        place.state = curve_state(*block_.curve, place.u);
        return place;
    }
    place.part = static_cast<float>(index) / static_cast<float>(count_);
    if (block_.shape == BlockShape::kArc) {
        place.turn = sin_cos(place.part * sweep(block_));
    }
    return place;
}

LaneDerivatives StretchReader::bounds_to(const Place& to) const noexcept
{
    if (block_.shape == BlockShape::kArc) {
        return to_lanes(arc_derivatives(block_.arc, begin_.turn, to.turn, to.part * sweep(block_)));
    }
    if (block_.shape == BlockShape::kCurve) {
        return curve_derivatives(begin_.state, curve_state(*block_.curve, 0.5F * (begin_.u + to.u)),
                                 to.state, to.s - begin_.s);
    }
    return to_lanes(line_derivatives(block_));
}

// End of a stretch that ends at a part of the block.
std::uint32_t StretchReader::end_at(float part) const noexcept
{
    return next_ == count_ ? block_.length
                           : static_cast<std::uint32_t>(static_cast<float>(block_.length) * part);
}

Stretch StretchReader::next() noexcept
{
    ++next_;
    if (block_.shape == BlockShape::kQuintic) {
        return next_of_quintic();
    }
    const Place to = place_at(next_);
    const bool is_curve = block_.shape == BlockShape::kCurve;
    const Stretch stretch{end_at(is_curve ? to.s / block_.curve->table.length() : to.part),
                          bounds_to(to)};
    begin_ = to;
    return stretch;
}

Stretch StretchReader::next_of_quintic() noexcept
{
    const QuinticFrame frame = quintic_frame(block_);
    const float part = static_cast<float>(next_) / static_cast<float>(count_);
    const LaneDerivatives middle = quintic_state(frame, 0.5F * (begin_.part + part));
    const LaneDerivatives end = quintic_state(frame, part);
    const float length = length_mm(block_) * (part - begin_.part);
    const Stretch stretch{end_at(part), quintic_derivatives(begin_.state, middle, end, length)};
    begin_.part = part;
    begin_.state = end;
    return stretch;
}

}  // namespace cusp::planner
