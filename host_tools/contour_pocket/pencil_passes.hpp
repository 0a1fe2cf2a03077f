// Passes along the feet of cliffs and creases of a floor: loops that cross them at an angle leave
// material between each other there.
#pragma once

#include <vector>

#include "host_tools/clearing/clearing.hpp"
#include "host_tools/contour_pocket/cl_path.hpp"
#include "host_tools/drop_cutter/drop_cutter.hpp"

namespace cusp::contour_pocket {

struct PencilSettings {
    double wall_clearance{};  // mm: least distance of the tool's axis from the contours
    double max_uncut{};       // mm: what may stay over the best that the tool reaches
    double distance{};        // mm: how far beside a jump passes run at least
    // Short lines are followed whatever they leave: else only where long ones leave more than
    // `max_uncut`.
    bool fragments{true};
    ClPathSettings
        path_settings;  // of passes; chords of a line keep within a third of its plan_tolerance
};

// Open and closed passes, all PassStart::kDrop. Where the height of the tip jumps, along all of the
// low side, `distance` from the jump, or up to four times as far where a pass can not be laid low
// otherwise; where only its slope turns up, along what the tool takes more than `max_uncut` off
// what the given passes leave, square to the floor: looked at every tenth of the tool's radius.
std::vector<clearing::ClearingPass> pencil_passes(const offset::Region2d& region,
                                                  const drop_cutter::DropCutter& floor,
                                                  const clearing::ClearedRegion& cleared,
                                                  const PencilSettings& settings);

}  // namespace cusp::contour_pocket
