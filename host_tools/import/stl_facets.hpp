// Triangles from STL files, binary and ASCII.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "firmware/base/vec.hpp"

namespace cusp::import {

struct Facets {
    std::vector<std::array<Vec3d, 3>> triangles;  // mm, corners in the file's order
    std::size_t degenerate{};                     // left out: coincident or collinear corners
};

// millimetres  of one unit of the file: STL does not name its unit
//
// Errors: InputError with file, line (ASCII) or facet (binary), value and limit: a truncated file,
// a coordinate that is not finite or beyond kLargestCoordinate, no facet with an area.
Facets read_stl(const std::string& file, double millimetres);

}  // namespace cusp::import
