// Waterline roughing with one cutter, after the cutters before it.
#pragma once

#include <memory>
#include <vector>

#include "host_tools/cam/adaptive_isocurve/level_floors.hpp"
#include "host_tools/cam/adaptive_isocurve/rough_depths.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::adaptive_isocurve {

struct RoughStock {
    offset::Box2d plan;
    double top;
    double bottom;
};

// The regions of a cutter's axis, level by level; fewer levels where it fits no deeper.
struct RoughedWaterlines {
    toolpath::Tool tool;
    std::vector<std::unique_ptr<offset::RegionOffset>> regions;
};

// Data common to the cutters of one operation.
struct RoughWork {
    const job::Job& job;
    const job::Operation& operation;
    const part_model::PartModel& model;
    RoughStock stock;
    RoughDepths depths;
    const LevelFloors& floors;
    double least_pitch;   // mm, of the lattices of slices
    double share_before;  // of the progress: before this cutter
    double share;         // of the progress: of this cutter
};

struct RoughedTool {
    toolpath::PlannedOperation planned;
    RoughedWaterlines levels;
    double keeps{};  // mm: largest distance of the slices from smooth walls
    int loops{};     // 0: no stock was left for this cutter, or it fits nowhere
};

// clearance  mm: least distance of the slices from the model, without the tolerance of fits
RoughedTool rough_with(const RoughWork& work,
                       const toolpath::Tool& tool,
                       double clearance,
                       const std::vector<RoughedWaterlines>& before);

}  // namespace cusp::adaptive_isocurve
