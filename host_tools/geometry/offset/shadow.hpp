// Shadows of triangles: what they cover, seen from above.
//
//     const Region2d walls = shadow_above(triangles, -4.0);   // what stands above z = -4
//     const Region2d floor = level_ground(triangles, -4.0);   // what is level at z = -4
//
// Where triangles meet at a shared edge there is no seam. Triangles that stand upright cover nothing.
// Accuracy: that of region_overlay.hpp.
#pragma once

#include <array>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::offset {

// mm: parts of triangles that rise no more above a height don't stand above it.
inline constexpr double kStandsAbove = 1e-3;

// mm: a triangle is level if its corners differ by no more in height.
inline constexpr double kLevelGround = 1e-5;

// The shadow of all that is higher than z + kStandsAbove. O(n log n).
Region2d shadow_above(const std::vector<std::array<Vec3d, 3>>& triangles, double z);

// The level triangles that are within kStandsAbove of z and not below another one that is higher.
Region2d level_ground(const std::vector<std::array<Vec3d, 3>>& triangles, double z);

// mm^2: less level ground is none. Of more than kMostLevels heights those with most of it count.
inline constexpr double kLeastLevel = 1.0;
inline constexpr std::size_t kMostLevels = 32;

// Heights of the level triangles that are seen from above, the lowest first, with their areas (mm^2).
struct LevelHeight {
    double z;
    double area;
};
std::vector<LevelHeight> level_heights(const std::vector<std::array<Vec3d, 3>>& triangles);

}  // namespace cusp::offset
