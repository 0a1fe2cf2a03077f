// Proofs for a level: its passes leave nothing, a way lies in its region or keeps off the stock.
#pragma once

#include <vector>

#include "host_tools/cam/clearing/clearing.hpp"

namespace cusp::adaptive_isocurve {

// True if the passes cover the region, as far as it lies in the box. At a point left out the next
// level would cut twice the depth.
//
// step  mm: the stepover that was asked for
bool covers(const clearing::ClearedRegion& cleared,
            const offset::Region2d& region,
            double step,
            const offset::Box2d& box);

// mm, from a place to the box; 0 inside.
double distance(const offset::Box2d& box, Vec2d place);

// False if the edge keeps that far off the box; true may be wrong by 0.001 mm.
bool comes_near(const offset::Box2d& box, const offset::Edge& edge, double distance);

// True if a line lies in the region, at least `radius` (mm) from its edge, but for 0.002 mm.
bool line_inside(const offset::RegionOffset& region, Vec2d from, Vec2d to, double radius = 0.0);

// True if a link lies in the region. Links are made from samples 0.1 mm apart, which is no proof.
bool line_inside(const offset::RegionOffset& region, const std::vector<offset::Edge>& way);

}  // namespace cusp::adaptive_isocurve
