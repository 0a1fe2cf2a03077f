// Exact union of axis-aligned rectangles: area and outline by a sweep that only compares
// coordinates.
#pragma once

#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::hull_rough {

struct Rectangle {
    double x_min{};
    double y_min{};
    double x_max{};
    double y_max{};
};

// Area of the part of the union inside `window`. O(n log n) for boxes of similar size.
double union_area(const std::vector<Rectangle>& boxes, const Rectangle& window);

// The outline of the union as closed loops of corners (the last joins the first), sides along x and
// y in turn; outer loops counter-clockwise, holes clockwise. Parts that touch in a point make one
// loop, as in Chuang & Pan, section 5.3. No arithmetic: every coordinate is one of the input's.
// Rectangles without area are left out.
std::vector<std::vector<Vec2d>> union_outline(const std::vector<Rectangle>& boxes);

}  // namespace cusp::hull_rough
