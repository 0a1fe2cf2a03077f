// Quintic pieces with given place, direction and curvature at both ends.
#pragma once

#include "firmware/base/vec.hpp"
#include "firmware/path/path.hpp"

namespace cusp::planner {

// Direction and curvature of a path at a place.
struct PathEnd {
    Vec3f tangent;    // unit vector
    Vec3f curvature;  // 1/mm, square to the tangent
};

// The Hermite quintic over a chord, mm, whose derivatives by arc length are those of the ends if
// it is `length` mm long.
path::Quintic hermite(Vec3f chord, const PathEnd& from, const PathEnd& to, float length) noexcept;

// The one whose mean speed is one. Returns false where its parameter is not arc length within
// `error`, relative.
bool make_quintic(Vec3f chord,
                  const PathEnd& from,
                  const PathEnd& to,
                  float error,
                  path::Quintic& piece) noexcept;

// From the start of the piece, mm, and the derivative by x, at x in [0, 1].
Vec3f point_at(const path::Quintic& piece, Vec3f chord, float x) noexcept;
Vec3f slope_at(const path::Quintic& piece, Vec3f chord, float x) noexcept;

}  // namespace cusp::planner
