// One cutter's way through the levels of a roughing, after the cutters before it.
#pragma once

#include <memory>
#include <vector>

#include "host_tools/adaptive_isocurve/rough_depths.hpp"
#include "host_tools/adaptive_isocurve/waterline_slices.hpp"
#include "host_tools/offset/offset.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::adaptive_isocurve {

struct RoughStock {
    offset::Box2d plan;
    double top;
    double bottom;
};

// Where a cutter has been, level by level; fewer levels where it fits no deeper.
struct RoughedWaterlines {
    toolpath::Tool tool;
    std::vector<std::unique_ptr<offset::RegionOffset>> regions;
};

// What the cutters of one operation share.
struct RoughWork {
    const job::Job& job;
    const job::Operation& operation;
    const part_model::PartModel& model;
    RoughStock stock;
    RoughDepths depths;
    double least_pitch;   // mm: of the lattices of slices
    double share_before;  // of the progress
    double share;
};

struct RoughedTool {
    toolpath::PlannedOperation planned;
    RoughedWaterlines levels;
    double keeps{};  // mm that the slices may keep from smooth walls, all in all
    int loops{};     // 0: nothing was left for this cutter, or it fits nowhere
};

// clearance  mm that the slices keep from the model at least, without what fits take
RoughedTool rough_with(const RoughWork& work,
                       const toolpath::Tool& tool,
                       double clearance,
                       const std::vector<RoughedWaterlines>& before);

}  // namespace cusp::adaptive_isocurve
