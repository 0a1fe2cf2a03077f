// Pencil passes: along the feet of cliffs and creases of a floor, where loops that cross them at an
// angle leave material.
#pragma once

#include <vector>

#include "host_tools/clearing/clearing.hpp"
#include "host_tools/contour_pocket/cl_path.hpp"
#include "host_tools/drop_cutter/drop_cutter.hpp"

namespace cusp::contour_pocket {

struct PencilSettings {
    double wall_clearance{};  // mm: least distance of the tool's axis from the contours
    double max_uncut{};       // mm: height that may stay over what the tool could cut
    double distance{};        // mm: how far beside a jump passes run at least
    // Short curves are followed always; else only where long ones leave more than `max_uncut`.
    bool fragments{true};
    // Chords of a curve keep within a third of the plan tolerance.
    ClPathSettings path_settings;
};

// Open and closed passes, all PassStart::kRetractAndDrop. Where the CL height jumps they run along
// all of the low side, `distance` from the jump, or up to four times as far where a nearer pass
// would climb. Where only its slope turns up they run where the tool cuts more than `max_uncut` off
// what the given passes leave, square to the floor, sampled every tenth of the tool's radius.
std::vector<clearing::ClearingPass> pencil_passes(const offset::Region2d& region,
                                                  const drop_cutter::DropCutter& floor,
                                                  const clearing::ClearedRegion& cleared,
                                                  const PencilSettings& settings);

}  // namespace cusp::contour_pocket
