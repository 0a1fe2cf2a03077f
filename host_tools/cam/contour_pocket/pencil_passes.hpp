// Pencil passes: along the feet of cliffs and creases of a floor, where loops that cross them at an
// angle leave stock.
#pragma once

#include <vector>

#include "host_tools/cam/cl_path/cl_path.hpp"
#include "host_tools/cam/clearing/clearing.hpp"
#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"

namespace cusp::contour_pocket {

struct PencilSettings {
    double wall_clearance{};  // mm: least distance of the tool's axis from the contours
    double max_uncut{};       // mm: height that may remain above what the tool can cut
    double distance{};        // mm: least distance of passes from a jump
    // true: short curves are always followed; false: only those of long ones that leave too much
    bool fragments{true};
    // Chords of a curve keep within a third of the plan tolerance.
    cl_path::ClPathSettings path_settings;
};

// Open and closed passes, all PassStart::kRetractAndDrop. If the CL height jumps they run along
// all of the low side, `distance` from the jump, or up to four times as far where a nearer pass
// would climb. If only its slope turns up they run where the tool removes more than `max_uncut`
// (mm, along the normal) of the stock that the given passes leave, sampled every tenth of the
// tool's radius.
std::vector<clearing::ClearingPass> pencil_passes(const offset::Region2d& region,
                                                  const drop_cutter::DropCutter& floor,
                                                  const clearing::ClearedRegion& cleared,
                                                  const PencilSettings& settings);

}  // namespace cusp::contour_pocket
