// One cutter's way through the levels of a roughing, after the cutters before it.
#pragma once

#include <memory>
#include <vector>

#include "host_tools/adaptive_isocurve/level_slice.hpp"
#include "host_tools/adaptive_isocurve/rough_depths.hpp"
#include "host_tools/offset/offset.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::host {

struct RoughStock {
    Box2d plan;
    double top;
    double bottom;
};

// Where a cutter has been, level by level; fewer levels where it fits no deeper.
struct RoughedLevels {
    Tool tool;
    std::vector<std::unique_ptr<RegionOffset>> regions;
};

// What the cutters of one operation share.
struct RoughWork {
    const Job& job;
    const Operation& operation;
    const SurfaceModel& model;
    RoughStock stock;
    RoughDepths depths;
    double least_pitch;   // mm: of the lattices of slices
    double share_before;  // of the progress
    double share;
};

struct RoughedTool {
    PlannedOperation planned;
    RoughedLevels levels;
    double keeps{};  // mm that the slices may keep from smooth walls, all in all
    int loops{};     // 0: nothing was left for this cutter, or it fits nowhere
};

// keep  mm that the slices keep from the model at least, without what fits take
RoughedTool rough_with(const RoughWork& work,
                       const Tool& tool,
                       double keep,
                       const std::vector<RoughedLevels>& before);

}  // namespace cusp::host
