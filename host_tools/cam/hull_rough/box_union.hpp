// Exact union of axis-aligned rectangles: its area and outline, by a sweep.
#pragma once

#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::hull_rough {

struct Rectangle {
    double x_min{};
    double y_min{};
    double x_max{};
    double y_max{};
};

// Area, mm^2, of the part of the union inside `window`. O(n log n) for boxes of similar size.
double union_area(const std::vector<Rectangle>& boxes, const Rectangle& window);

// The outline of the union as closed loops of corners (the last joins the first), with sides along
// x and y alternately. Outer loops are counter-clockwise, holes clockwise. Parts that touch in a
// point are one loop, as in Chuang & Pan, section 5.3. Coordinates are only compared: each is one
// of the input. Rectangles without area are ignored.
std::vector<std::vector<Vec2d>> union_outline(const std::vector<Rectangle>& boxes);

}  // namespace cusp::hull_rough
