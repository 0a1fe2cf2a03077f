// Block: a piece of path of at most 64 mm, in the form that the servo tick evaluates.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/math.hpp"
#include "firmware/base/path_units.hpp"
#include "firmware/base/vec.hpp"
#include "firmware/nurbs/arc_length_table.hpp"
#include "firmware/path/move.hpp"
#include "firmware/planner/speed_limit.hpp"

namespace cusp::planner {

enum class BlockShape : std::uint8_t { kLine, kArc, kCurve, kQuintic };

// The axis filters of a block: two box filters, their lengths in servo ticks.
struct AxisFilter {
    std::uint8_t first{1};
    std::uint8_t second{1};
    friend constexpr bool operator==(AxisFilter a, AxisFilter b) noexcept
    {
        return a.first == b.first && a.second == b.second;
    }
    friend constexpr bool operator!=(AxisFilter a, AxisFilter b) noexcept { return !(a == b); }
};

// An arc or helix of at most a quarter turn. With h the angle from its start:
//   (radius + spread h) turned by h, plus axial h.
struct ArcBlock {
    AxisVecf tangent;      // unit vector of the motion in the plane at the start
    AxisVecf normal;       // unit vector from the start to the centre
    AxisVecf axial;        // mm per radian
    float radius;          // mm
    float spread;          // mm per radian: how the radius changes
    float angle_per_unit;  // radians per path unit
};

// A rational Bezier piece with its parameter as a function of arc length.
struct CurveBlock {
    path::BezierPiece piece;
    nurbs::ArcLengthTable table;  // its last_found is the servo tick's
};

// The bulge that path::Quintic adds to the chord.
struct QuinticBlock {
    std::array<AxisVecf, 4> bulge;  // mm
};

inline constexpr std::uint16_t kWholeShare = 1U << 15U;
inline constexpr float kOverlapUnit = 2e-6F;  // s

struct Block {
    Block() noexcept : arc{} {}

    PathOffset displacement{};    // from start to end
    std::uint32_t length{0};      // path units, > 0, <= 64 mm
    std::uint32_t reciprocal{0};  // of the length: see fraction()
    std::uint8_t reciprocal_shift{0};
    BlockShape shape{BlockShape::kLine};
    path::MoveKind kind{path::MoveKind::kFeed};
    bool stops{false};                 // the path stops at its end
    bool disjoint{false};              // no axis moves on both sides of that stop
    std::uint8_t percent{100};         // of the programmed feed, that it is planned for
    std::uint16_t overlap{0};          // 2 us, that the next stretch begins before the stop
    std::uint16_t share{kWholeShare};  // parts of 2^15, of the axes' jerk on both sides of it
    float feed{0};                     // squared, (mm/s)^2
    float centripetal{0};  // mm/s^2, most for which the filters stay within their deviation
    AxisFilter filter{};
    path::LaserPower power;
    std::uint32_t line{0};
    union {
        ArcBlock arc;          // for kArc
        QuinticBlock quintic;  // for kQuintic
        CurveBlock* curve;     // for kCurve
    };
};

// Sets length and what depends on it. Precondition: 0 < length <= 64 mm.
void set_length(Block& block, std::uint32_t length) noexcept;

// offset / length in units of 2^-31, within 2^-30. Precondition: offset <= length.
inline std::uint32_t fraction(const Block& block, std::uint32_t offset) noexcept
{
    // The offset has at most reciprocal_shift + 1 bits: its top bit goes to bit 31 at most.
    const std::uint32_t shifted = offset << (31U - block.reciprocal_shift);
    return static_cast<std::uint32_t>((std::uint64_t{shifted} * block.reciprocal) >> 32U);
}

// On the chord. Precondition: offset < length.
inline PathOffset line_position(const Block& block, std::uint32_t offset) noexcept
{
    // Below 2^31, and twice a displacement of 64 mm is, too: a product, rounded to its upper word.
    const auto part = static_cast<std::int32_t>(fraction(block, offset));
    const auto scale = [part](std::int32_t whole) {
        const std::int64_t twice = std::int64_t{2 * whole} * part;
        return static_cast<std::int32_t>((twice + (std::int64_t{1} << 31)) >> 32);
    };
    return mapped(block.displacement, scale);
}

// As position_at(), of a block that is no line. Precondition: offset < length.
PathOffset curved_position(const Block& block, std::uint32_t offset) noexcept;

// The place at `offset` path units from the start, relative to the start; the exact displacement at
// the end. Within 1 nm of the true path on lines, 2 nm on arcs and
// 4 nm on curves. Context: servo tick.
inline PathOffset position_at(const Block& block, std::uint32_t offset) noexcept
{
    if (offset >= block.length) {
        return block.displacement;
    }
    return block.shape == BlockShape::kLine ? line_position(block, offset)
                                            : curved_position(block, offset);
}

// Direction and curvature vector of the block at one of its ends, for the junction with its
// neighbour.
struct EndGeometry {
    AxisVecf tangent;    // dP/ds
    AxisVecf curvature;  // d2P/ds2, 1/mm
};
EndGeometry start_geometry(const Block& block) noexcept;
EndGeometry end_geometry(const Block& block) noexcept;

// True if a block is passed within half a tick at a speed, mm/s.
bool is_within_half_tick(const Block& block, float speed) noexcept;

// The direction in which a block is left, as the axis filters feel it: that of its start if it is passed within half a
// tick at the speed of its bend, too. Then it is a turn at its end. Precondition: is_within_half_tick().
AxisVecf felt_end(const Block& block, AxisVecf start, AxisVecf end) noexcept;

// The first three derivatives of the place by arc length, with signs, at `s` mm from the start.
// Precondition: 0 <= s <= the length. Context: main loop.
LaneDerivatives derivatives_at(const Block& block, float s) noexcept;

// A block is cut into stretches of nearly constant direction and curvature.
unsigned stretch_count(const Block& block) noexcept;

struct Stretch {
    std::uint32_t end;  // path units from the start of the block
    LaneDerivatives derivatives;
};

// The stretches of a block in order. The end of one is the beginning of the next, and is computed
// once.
class StretchReader {
public:
    // From the stretch `index` on. The block must outlive the reader.
    // Precondition: index < stretch_count(block).
    StretchReader(const Block& block, unsigned index) noexcept;

    // Precondition: fewer than stretch_count(block) are read.
    Stretch next() noexcept;

    const Block& block() const noexcept { return block_; }

private:
    // Between two stretches.
    struct Place {
        float part;             // of the block's stretches
        float s;                // mm from the start of a curve
        float u;                // parameter of a curve
        LaneDerivatives state;  // by arc length, with signs: not of arcs
        SinCos<float> turn;     // of the angle on an arc
    };
    Place place_at(unsigned index) const noexcept;
    LaneDerivatives bounds_to(const Place& to) const noexcept;
    std::uint32_t end_at(float part) const noexcept;
    Stretch next_of_quintic() noexcept;

    const Block& block_;
    unsigned next_;
    unsigned count_;
    Place begin_;
};

// Precondition: index < stretch_count(block).
inline Stretch stretch(const Block& block, unsigned index) noexcept
{
    return StretchReader{block, index}.next();
}

}  // namespace cusp::planner
