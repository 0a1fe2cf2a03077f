// How far apart two passes of a ball may lie so that the cusp between them stays below a height.
#pragma once

#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::contour_pocket {

// Distance in plan between two positions of the ball's centre, mm.
//
//   radius     of the ball, mm, > 0
//   scallop_height  height of the ridge left between the passes, mm, in (0, radius)
//   curvature  of the floor across the passes, 1/mm, > 0 where it bends away from the tool (convex)
//   slope      of the floor across the passes, dz over plan distance
//
// Where the floor is bent tighter than the ball (it can't enter) or the formula gives more than
// half again the distance of a flat floor, that is the answer: curvature seldom stays so for so
// far.
//
// Source: Suh & Lee 1990, eq. (16)-(18), as corrected in docs/papers.md; theirs is the distance of
// the contacts, this is the distance of the centres, whose paths are offset here.
double stepover(double radius, double scallop_height, double curvature, double slope);

// The same for any tool. A flat or bull-nose end mill leaves its corner's ridge where the floor
// rises across the passes, its foot's flat where it does not, and a ridge as of a larger ball where
// the passes climb; the least of what these allow is taken.
//
//   slope_along  of the floor along the passes, dz over plan distance
double stepover(const toolpath::Tool& tool,
                double scallop_height,
                double curvature,
                double slope,
                double slope_along);

}  // namespace cusp::contour_pocket
