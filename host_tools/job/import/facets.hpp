// Triangles of a mesh file, checked: what the readers of STL, OBJ and 3MF share.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "firmware/base/vec.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/nurbs_validity.hpp"

#include "fmt/format.h"

namespace cusp::import {

struct Facets {
    std::vector<std::array<Vec3d, 3>> triangles;  // mm, corners in the file's order
    std::size_t degenerate{};                     // left out: coincident or collinear corners
    std::string unit{};  // of length, as the file names it; "": it does not
    std::string note{};  // on what the reader changed; "": nothing
};

// Appends the triangle, or counts it as degenerate where it is no higher than 1e-9 mm.
void add_facet(const std::array<Vec3d, 3>& corners, Facets& facets);

// Errors: InputError with the file: no facet with an area, or no width in x or y.
void check_facets(const Facets& facets, const std::string& file);

// place()  the place of the corner, in words
//
// Errors: InputError where a coordinate, in mm, is no number or beyond kLargestCoordinate.
template <class Place>
void check_corner(Vec3d corner, const Place& place)
{
    for (unsigned axis = 0; axis < 3; ++axis) {
        if (!(std::abs(corner[axis]) <= kLargestCoordinate)) {  // also refuses NaN
            throw InputError(fmt::format("{}: a corner has {} = {} mm, the limit is {:g}", place(),
                                         "xyz"[axis], corner[axis], kLargestCoordinate));
        }
    }
}

}  // namespace cusp::import
