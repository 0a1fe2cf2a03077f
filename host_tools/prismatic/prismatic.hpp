// The 2.5-D operations of a shop: cuts along curves of a drawing at level depths.
//
//     operation.strategy = "profile";
//     operation.prismatic->loops = {{outline, "plate.dxf#outline", false}};
//     operation.prismatic->depth = 6.0;
//     operation.prismatic->tabs = {4, {}, 6.0, 1.5, true};
//     const std::vector<toolpath::PlannedOperation> planned = plan_profile(job, operation);
//     planned.front().path.moves;  // outside the outline, a tool's radius from it
//
// A pocket of a level floor is planned by contour_pocket.
#pragma once

#include <vector>

#include "host_tools/job/job.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::prismatic {

// Each loop once around at every level, then at the bottom where an allowance was left; inner loops
// first. The tool's centre keeps its radius from the loops, within 0.001 mm and never less than
// that below it (tests/property/prismatic). Tabs stand from the bottom to their height.
//
// Errors: InputError where the tool fits along none of the loops, with a place; tabs that find no
// room. A loop that the tool fits nowhere along, and stretches that it does not reach, are warnings.
std::vector<toolpath::PlannedOperation> plan_profile(const job::Job& job,
                                                     const job::Operation& operation);

// Straight down at every hole, in pecks where asked for, in the order of a short tour.
std::vector<toolpath::PlannedOperation> plan_drill(const job::Job& job,
                                                   const job::Operation& operation);

// Passes along x over the stock, or over the box of the operation's loops, to a level.
//
// Errors: InputError where neither gives x and y.
std::vector<toolpath::PlannedOperation> plan_face(const job::Job& job,
                                                  const job::Operation& operation);

// The tip along every chain of curves, at the depth.
std::vector<toolpath::PlannedOperation> plan_engrave(const job::Job& job,
                                                     const job::Operation& operation);

// A vee along the outside of the loops' material: the flank cuts `width` off its upper edge.
//
// Errors: InputError where the vee is too small for the width, or fits along none of the loops.
std::vector<toolpath::PlannedOperation> plan_chamfer(const job::Job& job,
                                                     const job::Operation& operation);

// A vee between the outlines, as deep everywhere as both walls allow: along the medial axis, with
// sharp corners. No deeper than the depth: there is a level floor then. The flanks touch the
// outlines at the top, within 0.001 mm and never beyond (tests/property/prismatic).
//
// Errors: InputError where the tip fits nowhere between the outlines, with the widest place; more
// than 20 000 loops on the floor.
std::vector<toolpath::PlannedOperation> plan_v_carve(const job::Job& job,
                                                     const job::Operation& operation);

}  // namespace cusp::prismatic
