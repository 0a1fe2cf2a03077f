// Vectors in the plan, beside those in space of firmware/base.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/base/vec.hpp"

namespace cusp {

// "Nothing" in numbers. A query that may find nothing returns a std::optional; these are for bounds
// and rasters. tests/checks/constants.py refuses others.
//
// The bound that is not set, and the least of no values.
inline constexpr double kInfinite = std::numeric_limits<double>::infinity();
// As kInfinite, for coordinates and distances (mm) that are calculated with: 0 * kUnbounded and
// kUnbounded - kUnbounded are 0, where kInfinite gives NaN.
inline constexpr double kUnbounded = 1e300;
// A value of a raster where nothing determines one. Equal to nothing: ask std::isnan().
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

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
// From a point to a segment.
inline double distance_to_segment(Vec2d p, Vec2d begin, Vec2d end)
{
    const Vec2d way = end - begin;
    const double squared = dot(way, way);
    const double share = squared > 0 ? std::clamp(dot(p - begin, way) / squared, 0.0, 1.0) : 0.0;
    return norm(p - (begin + way * share));
}
// Seen from above.
inline Vec2d in_plan(Vec3d p) { return {p.x, p.y}; }

}  // namespace cusp
