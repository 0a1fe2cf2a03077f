// Boxes around places where stock is left.
#pragma once

#include <vector>

#include "host_tools/offset/contour.hpp"

namespace cusp::adaptive_clearing {

offset::Box2d grown_box(offset::Box2d box, double by);

// mm: 0 inside.
double distance_to(const offset::Box2d& box, Vec2d p);

// Stock in one corner has a box for each of its pieces: such that hardly differ become one.
std::vector<offset::Box2d> joined(const std::vector<offset::Box2d>& boxes);

}  // namespace cusp::adaptive_clearing
