// A piece of a wall that is vertical or nearly so: a plane polygon, and how far the part may be off
// it.
#pragma once

#include <vector>

#include "firmware/base/vec.hpp"

namespace cusp::finishing {

// Each vertical line crosses it once at most: its columns are single intervals. The normal of a
// curved face turns evenly along the facet.
struct WallFacet {
    std::vector<Vec3d> corners;  // at least 3, in one plane
    Vec3d normal;                // of that plane, unit, never downward
    double bend{};               // 1/mm: how much the normal turns along the facet
    double middle{};             // mm along the facet: where it is `normal`
    double off{};                // mm: how far the part, raised by the scallop, is off the facet
};

}  // namespace cusp::finishing
