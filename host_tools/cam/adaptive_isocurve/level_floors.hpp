// Level ground of a part, which the flat end that roughs cuts to size; a ball has nothing to do there.
//
//     const LevelFloors floors = level_floors(job, operation);
//     for (const LevelFloor& floor : floors.levels()) {
//         floor.z;                 // mm: of the tip
//         floor.cleared.passes;    // all over the floor, as far as walls and the allowance let the tool
//     }
//     floors.is_free({20, 5, -4}, {30, 5, -4}, 2.0);  // a ball of radius 2 mm cuts nothing on its way
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"
#include "host_tools/cam/clearing/clearing.hpp"
#include "host_tools/cam/finishing/surface_operation.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::adaptive_isocurve {

struct LevelFloor {
    double z;
    std::unique_ptr<offset::RegionOffset> centres;  // of the tool's axis: over the floor
    std::unique_ptr<offset::RegionOffset> swept;    // by the tool, 0.02 mm less
    clearing::ClearedRegion cleared{};              // empty with a bounded engagement
    std::optional<adaptive_clearing::AdaptivePath> adaptive{};
};

class LevelFloors {
public:
    // The tool that cuts them; none where there are no floors.
    const std::optional<toolpath::Tool>& tool() const { return tool_; }
    // From the top down.
    const std::vector<LevelFloor>& levels() const { return levels_; }

    // True if a ball whose tip goes straight from `a` to `b` meets nothing, once the floors are cut.
    //
    // radius  mm, of the ball
    bool is_free(Vec3d a, Vec3d b, double radius) const;

private:
    friend LevelFloors level_floors(const job::Job& job, const job::Operation& operation);
    std::optional<toolpath::Tool> tool_;
    std::vector<LevelFloor> levels_;
};

// The floors below the stock's top that the smallest flat end of the roughing tools covers by passes
// over them: horizontal surfaces or facets, the 12 heights of the greatest area. None without
// roughing or without a flat end.
//
// The axis keeps to slices of the part above the floor (`WaterlineSlices`), so the tool touches
// nothing but the floor, and keeps the allowance from all else that rises from it.
LevelFloors level_floors(const job::Job& job, const job::Operation& operation);

// The finish by a ball leaves out what the floors' tool has cut. The floors outlive the work.
void leave_out(const LevelFloors& floors, finishing::SurfaceOperation& work);

}  // namespace cusp::adaptive_isocurve
