// The geometry of one move: a line, an arc or helix, one rational Bezier piece, or a quintic.
//
// All are relative to the start of the move, in millimetres; start and end themselves are
// exact positions (Move). Parameters run over [0, length] by arc length where a name says `at`.
//
//   ArcWords words{start, end, Plane::kXY, true, 0, -10'000'000, 1};  // G2 I0 J-10
//   Result<Arc> arc = make_arc(words);
//   if (arc) { Move move; move.path = *arc; move.start = start; move.end = end; }
#pragma once

#include <array>
#include <cstdint>
#include <variant>

#include "firmware/base/result.hpp"
#include "firmware/base/vec.hpp"

namespace cusp::path {

// Straight from start to end of the move.
struct Line {};

// A circular arc or helix in any plane. With t in [0, 1] the point is
//   centre + (radius + t radius_change) (cos(t sweep) u + sin(t sweep) v) + t axial.
struct Arc {
    AxisVecd centre;       // from the start of the move
    AxisVecd u;            // unit vector from the centre to the start
    AxisVecd v;            // unit vector, square to u, towards the motion
    AxisVecd axial;        // travel along the axis of the plane; zero for a flat arc
    double radius;         // mm, > 0, at the start
    double radius_change;  // mm, end radius minus start radius: rounding of the program's numbers
    double sweep;          // radians, > 0; over 2 pi for several turns
};

inline constexpr std::uint32_t kMaxOrder = 5;

// A rational Bezier curve of degree order - 1 over t in [0, 1].
struct BezierPiece {
    std::uint8_t order;  // 2 to kMaxOrder
    // Control points relative to the start of the move, mm; the first is zero, the last is the end.
    AxisVecf points[kMaxOrder];
    float weights[kMaxOrder];  // > 0
};

// A bulge over the chord, nearly by arc length. With x in [0, 1] and D from start to end of the move
// the point is
//   x D + x (1 - x) (q0 + q1 x + q2 x^2 + q3 x^3).
struct Quintic {
    std::array<AxisVecf, 4> bulge;  // q0 to q3, mm
    float length;                   // mm
    bool is_transition;             // between a line and an arc, or two arcs
};

using Path = std::variant<Line, Arc, BezierPiece, Quintic>;

enum class Plane : std::uint8_t { kXY, kZX, kYZ };  // G17, G18, G19

// The words of an arc, its numbers in machine nanometres.
struct ArcWords {
    Position start;
    Position end;
    Plane plane;
    bool clockwise;                 // G2, seen from the plane's positive normal
    std::int64_t first_offset_nm;   // start to centre along the plane's first axis (I, K, J)
    std::int64_t second_offset_nm;  // along its second (J, I, K)
    std::int32_t turns;  // P word: 1 for the plain arc; a full circle where start and end agree
    bool inches{false};  // the program's unit: it chooses the tolerance of the radii
};

// Makes an arc of centre offsets.
//
// Errors:
//   kGcodeInvalidTarget  the radii at start and end differ by more than the tolerance and 0.1 % of the
//                        greater, or by more than 100 tolerances, or one of them is 0. Within that
//                        the radius goes linearly in angle from one to the other. The tolerance is
//                        0.0283 mm, with `inches` 0.00283 inch: two ends, each off by as much in x
//                        and y as a last digit of 2 decimals, in inches 3, may be (LinuxCNC).
Result<Arc> make_arc(const ArcWords& words) noexcept;

// The centre offsets of a radius word: fills the offsets of `words`.
//
//   radius_nm  > 0 for the arc of at most a half turn, < 0 for the longer one.
//
// Errors:
//   kGcodeArcRadiusError  the radius is less than half the chord by more than 0.005 mm
//   kGcodeInvalidTarget   start and end agree
Result<ArcWords> with_radius(ArcWords words, std::int64_t radius_nm) noexcept;

}  // namespace cusp::path
