// How wide a tool is near a plane that it touches: what one pass of any end leaves flat enough.
#pragma once

#include "host_tools/geometry/part_model/facet_drop.hpp"

namespace cusp::part_model {

// mm: how far along a way, from where it touches the plane, the tool is no higher over it than
// `height`; kInfinite along a flank that is square to the plane.
//
// normal  of the plane, unit, upward
// way     unit, in the plane
// height  mm > 0, less than the corner radius if there is one
//
// The distance between two passes whose ridge has that height is the sum of both ways.
double cap_reach(const ToolProfile& tool, Vec3d normal, Vec3d way, double height);

}  // namespace cusp::part_model
