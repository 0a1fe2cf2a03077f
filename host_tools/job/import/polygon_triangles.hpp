// Triangles of a polygon in space.
#pragma once

#include <array>
#include <vector>

#include "firmware/base/vec.hpp"

namespace cusp::import {

// size - 2 triangles with the polygon's sense, by cutting ears (Meisters 1975), seen along its mean
// normal (Newell). A simple plane polygon is covered exactly; of others no more is promised than
// that all corners are used. Work grows with the square of the corners.
//
// corners  three at least
std::vector<std::array<Vec3d, 3>> polygon_triangles(std::vector<Vec3d> corners);

}  // namespace cusp::import
