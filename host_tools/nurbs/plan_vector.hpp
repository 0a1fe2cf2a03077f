// Vectors in the plan, beside those in space of firmware/base.
#pragma once

#include <cmath>
#include <limits>

#include "firmware/base/vec.hpp"

namespace cusp {

inline constexpr double kInfinite = std::numeric_limits<double>::infinity();
// A coordinate or distance beyond every real one, in mm: what a search for the least starts at, or
// a limit that is not set. Finite, so that 0 * kUnbounded and kUnbounded - kUnbounded are 0, where
// kInfinite gives NaN. "Nothing found" is a std::optional instead.
inline constexpr double kUnbounded = 1e300;

struct Vec2d {
    double x{};
    double y{};
    friend Vec2d operator+(Vec2d a, Vec2d b) { return {a.x + b.x, a.y + b.y}; }
    friend Vec2d operator-(Vec2d a, Vec2d b) { return {a.x - b.x, a.y - b.y}; }
    friend Vec2d operator*(Vec2d a, double k) { return {a.x * k, a.y * k}; }
    friend Vec2d operator*(double k, Vec2d a) { return a * k; }
};

inline double dot(Vec2d a, Vec2d b) { return a.x * b.x + a.y * b.y; }
inline double cross(Vec2d a, Vec2d b) { return a.x * b.y - a.y * b.x; }
inline double norm(Vec2d a) { return std::sqrt(dot(a, a)); }
// Seen from above.
inline Vec2d in_plan(Vec3d p) { return {p.x, p.y}; }

}  // namespace cusp
