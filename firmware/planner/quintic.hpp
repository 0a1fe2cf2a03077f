// Quintic pieces with given place, direction and curvature at both ends.
#pragma once

#include <array>

#include "firmware/base/lane_vec.hpp"
#include "firmware/base/vec.hpp"
#include "firmware/path/path.hpp"

namespace cusp::planner {

// Direction and curvature of a path at a place.
struct PathEnd {
    AxisVecf tangent;    // unit vector
    AxisVecf curvature;  // 1/mm, square to the tangent
};

// The Hermite quintic over a chord, mm, whose derivatives by arc length are those of the ends if
// it is `length` mm long.
path::Quintic hermite(AxisVecf chord,
                      const PathEnd& from,
                      const PathEnd& to,
                      float length) noexcept;

// The one whose mean speed is one. Returns false where its parameter is not arc length within
// `error`, relative.
bool make_quintic(AxisVecf chord,
                  const PathEnd& from,
                  const PathEnd& to,
                  float error,
                  path::Quintic& piece) noexcept;

// A piece ready to be asked for many places.
struct LaneQuintic {
    LaneVec chord;
    std::array<LaneVec, 4> bulge;
};

inline LaneQuintic lane_quintic(const std::array<AxisVecf, 4>& q, AxisVecf chord) noexcept
{
    return {to_lanes(chord), {{to_lanes(q[0]), to_lanes(q[1]), to_lanes(q[2]), to_lanes(q[3])}}};
}

inline LaneVec bulge_at(const LaneQuintic& piece, float x) noexcept
{
    const auto& q = piece.bulge;
    return q[0] + (q[1] + (q[2] + q[3] * x) * x) * x;
}

// From the start of the piece, mm, and the derivative by x, at x in [0, 1].
inline LaneVec point_at(const LaneQuintic& piece, float x) noexcept
{
    return piece.chord * x + bulge_at(piece, x) * (x * (1.0F - x));
}
inline LaneVec slope_at(const LaneQuintic& piece, float x) noexcept
{
    const auto& q = piece.bulge;
    return piece.chord + bulge_at(piece, x) * (1.0F - 2.0F * x) +
           (q[1] + (q[2] * 2.0F + q[3] * (3.0F * x)) * x) * (x * (1.0F - x));
}

}  // namespace cusp::planner
