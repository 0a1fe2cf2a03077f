// Triangles divided across their longest sides.
#pragma once

#include <array>
#include <vector>

#include "firmware/base/vec.hpp"

namespace cusp::finishing {

using Corners = std::array<Vec3d, 3>;

// The longest side of a triangle and its number.
struct LongSide {
    double length;
    std::size_t side;
};
LongSide longest_side(const Corners& corners);

std::array<Corners, 2> halves_of(const Corners& corners, std::size_t side);

// The triangle in parts of no side longer than `longest`; several thousand parts at most.
std::vector<Corners> parts_of(const Corners& corners, double longest);

double area_of(const Corners& corners);

// A part of a facet.
struct FacetCell {
    Corners corners;
    Vec3d normal;

    Vec3d middle() const { return (corners[0] + corners[1] + corners[2]) / 3.0; }
};

}  // namespace cusp::finishing
