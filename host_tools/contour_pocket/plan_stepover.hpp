// Stepover in plan, where loops are offset: of a ball over a slope, and of flat and bull-nose
// tools.
#pragma once

#include "host_tools/drop_cutter/drop_cutter.hpp"
#include "host_tools/toolpath/tool.hpp"

namespace cusp::contour_pocket {

// Distance in plan between two positions of a ball's centre, mm, by toolpath::stepover().
//
//   curvature  of the floor across the passes, 1/mm, > 0 where it is convex
//   slope      of the floor across the passes, dz over plan distance
//
// At most half again the distance of a flat floor; that of a flat floor where the ball does not fit
// or no scallop gets that high.
double plan_stepover(double radius, double scallop_height, double curvature, double slope);

// The same for any tool over a section of the floor. A flat or bull-nose end mill leaves its
// corner's scallop where the floor rises across the passes, that of its flat bottom where it does
// not, and that of a larger ball where the passes climb; the least of what these allow is taken.
double plan_stepover(const toolpath::Tool& tool,
                     double scallop_height,
                     const drop_cutter::DropCutter::Section& section);

}  // namespace cusp::contour_pocket
