// Finds the place with the most room for an entry from above.
#pragma once

#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::adaptive_clearing {

// True if the point lies in the part, and in none of its holes.
bool is_inside(const offset::Region2d& region, const offset::RegionPart& part, Vec2d point);

// The place of a grid over the part that is farthest from the walls, 48 by 48 over its box; where no
// grid point lies inside, a place on its contour.
Vec2d deepest_place(const offset::Region2d& region,
                    const offset::RegionPart& part,
                    const offset::RegionOffset& walls);

// The place that is farthest from the walls among those that lead to it from `place` in ever smaller
// steps, from `step` (mm) to a five-hundredth of it.
Vec2d deepest_near(Vec2d place, double step, const offset::RegionOffset& walls);

}  // namespace cusp::adaptive_clearing
