// Triangles to draw, as a block of 32-bit numbers.
#pragma once

#include <array>
#include <vector>

#include "host_tools/cam/engine/calls.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::engine {

// Adds a block "facets-N" of 9 little-endian floats a triangle, mm: x, y, z of its corners. Surfaces are within
// a thousandth of their size. Returns {"triangles", "block"}.
Json facets_json(const Call& call,
                 const std::vector<nurbs::Surface>& surfaces,
                 const std::vector<std::array<Vec3d, 3>>& triangles);

// The bytes of 32-bit floats, little-endian.
std::string float_bytes(const std::vector<float>& values);

}  // namespace cusp::engine
