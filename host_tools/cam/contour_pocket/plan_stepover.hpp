// Stepover in plan, in which loops are offset: of a ball on a slope, and of flat and bull-nose
// tools.
#pragma once

#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/toolpath/tool.hpp"

namespace cusp::contour_pocket {

// mm: distance in plan between two positions of a ball's centre, by toolpath::stepover().
//
// curvature  of the floor across the passes, 1/mm, > 0 where it is convex
// slope      of the floor across the passes, dz over plan distance
//
// At most 1.5 times the stepover of a flat floor; equal to it where the ball does not fit or no
// scallop reaches that height.
double plan_stepover(double radius, double scallop_height, double curvature, double slope);

// The stepover of any tool over a section of the floor. A flat or bull-nose end mill leaves a
// scallop of its corner where the floor rises across the passes, of its flat bottom where it does
// not, and of a larger ball where the passes climb. The least stepover of these is returned.
double plan_stepover(const toolpath::Tool& tool,
                     double scallop_height,
                     const drop_cutter::DropCutter::Section& section);

}  // namespace cusp::contour_pocket
