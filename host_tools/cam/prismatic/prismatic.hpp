// The 2.5-D operations of a shop: cuts along curves of a drawing at level depths.
//
//     operation.strategy = &kProfile;
//     operation.prismatic->loops = {{outline, "plate.dxf#outline", false}};
//     operation.prismatic->depth = 6.0;
//     operation.prismatic->tabs = {4, {}, 6.0, 1.5, true};
//     const std::vector<toolpath::PlannedOperation> planned = plan_profile(job, operation);
//     planned.front().path.moves;  // outside the outline, a tool's radius from it
//
// A pocket of a level floor is planned by contour_pocket.
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::prismatic {

// The records of the strategies below.
extern const job::Strategy kProfile;
extern const job::Strategy kDrill;
extern const job::Strategy kBore;
extern const job::Strategy kThreadMill;
extern const job::Strategy kSlot;
extern const job::Strategy kFace;
extern const job::Strategy kEngrave;
extern const job::Strategy kVCarve;
extern const job::Strategy kChamfer;

// Cuts around each loop at every level, then at the bottom where an allowance was left; inner loops
// first. The tool's centre stays one radius from the loops, within 0.001 mm (tests/property/prismatic).
// Tabs reach from the bottom to their height.
//
// Errors: InputError where the tool fits along none of the loops, with a place; tabs that find no
// room. A loop that the tool fits nowhere along, and stretches that it does not reach, are warnings.
std::vector<toolpath::PlannedOperation> plan_profile(const job::Job& job,
                                                     const job::Operation& operation);

// Drills every hole, in pecks where the job has them, in the order of a short tour.
std::vector<toolpath::PlannedOperation> plan_drill(const job::Job& job,
                                                   const job::Operation& operation);

// Faces the stock, or the bounding box of the operation's loops, by passes along x down to a level.
//
// Errors: InputError where neither gives x and y.
std::vector<toolpath::PlannedOperation> plan_face(const job::Job& job,
                                                  const job::Operation& operation);

// Moves the tip along every chain of curves, at the depth. With a floor it follows the surface: as far below as the
// depth where the tip alone (toolpath/tool_tip.hpp), dropped on it, would stand. The flanks are not looked at.
//
// Accuracy: heights along each move are within half the floor tolerance (off_by_curvature() and off_by_slope() of
// drop_cutter/line_heights.hpp), but for moves of 0.001 mm at a vertical step of the floor; the chord of a curve
// takes up to the other half of the flank. `EngraveFloorProperty` tests it on random floors.
//
// Errors: InputError where there is no floor under a curve, with the place.
std::vector<toolpath::PlannedOperation> plan_engrave(const job::Job& job,
                                                     const job::Operation& operation);

// Moves a vee along the outside of the material: its flank cuts `width` off the upper edge.
//
// Errors: InputError where the vee is too small for the width, or fits along none of the loops.
std::vector<toolpath::PlannedOperation> plan_chamfer(const job::Job& job,
                                                     const job::Operation& operation);

// Moves a vee along the medial axis between the outlines, everywhere as deep as both walls allow,
// so corners are sharp. If that exceeds the depth, the floor is level. At the top the flanks touch
// the outlines, within 0.001 mm and never beyond (tests/property/prismatic).
//
// Errors: InputError where the tip fits nowhere between the outlines, with the widest place; more
// than 20 000 loops on the floor.
std::vector<toolpath::PlannedOperation> plan_v_carve(const job::Job& job,
                                                     const job::Operation& operation);

}  // namespace cusp::prismatic
