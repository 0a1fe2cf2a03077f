// Boxes around places where stock is left.
#pragma once

#include <vector>

#include "host_tools/cam/adaptive_clearing/wall_passes.hpp"
#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::adaptive_clearing {

offset::Box2d grown_box(offset::Box2d box, double by);

// mm: 0 inside.
double distance_to(const offset::Box2d& box, Vec2d p);

// Stock in one corner has a box for each of its pieces: such that hardly differ become one.
std::vector<offset::Box2d> joined(const std::vector<offset::Box2d>& boxes);

// Around the stock left along the contours of the regions in the spot of the space, and half
// a radius of the tool more.
std::vector<offset::Box2d> spots_along(const std::vector<const offset::Region2d*>& regions,
                                       const WallSpace& space);

// Radians: the greatest turn to the left about one centre in the spot; 0 where there is none.
double turns_by(const offset::Region2d& region, const offset::Box2d& spot);

// Takes the spot nearest to the place out of them. Precondition: there is one.
offset::Box2d take_nearest(std::vector<offset::Box2d>& spots, Vec2d place);

}  // namespace cusp::adaptive_clearing
