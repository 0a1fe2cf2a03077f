// The parameter of a rational Bezier piece as a function of arc length: quintic Hermite pieces
// u(s).
//
// Built in the main loop, read in the servo tick; float throughout, relative to the piece.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/vec.hpp"
#include "firmware/path/path.hpp"

namespace cusp::nurbs {

// A node of the table: the parameter and its derivatives by arc length.
struct ArcLengthNode {
    float s;    // mm from the start of the piece
    float u;    // in [0, 1]
    float du;   // du/ds, 1/mm
    float ddu;  // d2u/ds2, 1/mm^2
};

inline constexpr unsigned kMaxArcLengthNodes = 16;

struct ArcLengthTable {
    std::array<ArcLengthNode, kMaxArcLengthNodes> nodes;
    std::uint8_t size{0};        // 2 to kMaxArcLengthNodes once made
    std::uint8_t last_found{0};  // interval, for whoever calls parameter_at() again and again

    // mm
    float length() const noexcept { return nodes[size - 1U].s; }
};

// Relative difference allowed between the speed along the curve and ds/dt.
// tests/unit/nurbs/arc_length_table_test.cpp holds it on random pieces.
inline constexpr float kMaxSpeedError = 1e-4F;

// Fills the table: nodes where |dP/ds| - 1 stays below kMaxSpeedError between them.
//
// Returns false where kMaxArcLengthNodes do not suffice, or where dP/du vanishes; never for a piece
// of PieceStream, which splits until they do. Context: main loop.
bool make_arc_length_table(const path::BezierPiece& piece, ArcLengthTable& table) noexcept;

// The parameter at arc length s, clamped to the piece.
//
//   interval  that of the previous call, 0 at first. Calls with rising or falling s take O(1).
//
// Context: servo tick.
float parameter_at(const ArcLengthTable& table, float s, std::uint8_t& interval) noexcept;

// The point at parameter u in [0, 1], mm from the start of the piece; exactly the first and last
// control points at 0 and 1. Context: servo tick.
AxisVecf point_at(const path::BezierPiece& piece, float u) noexcept;

// A point and the derivatives of the position by arc length.
struct CurveState {
    AxisVecf position;   // mm from the start of the piece
    AxisVecf tangent;    // unit vector
    AxisVecf curvature;  // d2P/ds2, 1/mm
    AxisVecf change;     // d3P/ds3, 1/mm^2
    float du;            // du/ds, 1/mm
    float ddu;           // d2u/ds2, 1/mm^2
};

// At parameter u in [0, 1]. If |dP/du| is below 1e-12 mm all derivatives are zero. Relative
// accuracy about 1e-5 of the derivatives by u. Context: main loop.
CurveState state_at(const path::BezierPiece& piece, float u) noexcept;

}  // namespace cusp::nurbs
