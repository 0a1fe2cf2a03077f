// How low the tools get over single places of the floor, where the grid of heights is too coarse
// for the verdict.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host_tools/drop_cutter/drop_cutter.hpp"
#include "host_tools/drop_cutter/lowest_position_search.hpp"
#include "host_tools/part_model/part_model.hpp"
#include "host_tools/toolpath/toolpath.hpp"
#include "host_tools/verify/floor_samples.hpp"
#include "host_tools/verify/wall_distance.hpp"

namespace cusp::verify {

// Drops each tool on the surfaces themselves, improved from the best places of a grid an eighth of
// the radius fine (`LowestPositionSearch`). Where a ball gets no lower on points of the floor
// alone, it gets no lower on the surfaces, and these are left out. Not for use by two threads at
// once.
class ToolAccess {
public:
    // samples   points of the floor
    // path_clearance  mm: how far the tools have to stay off the floor
    ToolAccess(const std::vector<nurbs::Surface>& surfaces,
               const std::vector<std::array<Vec3d, 3>>& mesh,
               const std::vector<toolpath::Tool>& tools,
               const std::vector<WallDistance>& walls,
               const FloorSamples& samples,
               double path_clearance);
    ToolAccess(const ToolAccess&) = delete;  // its searches drop tools of its own
    ToolAccess& operator=(const ToolAccess&) = delete;

    // Returns the height that the tools leave at best straight over the place; infinite where none
    // can come. Accuracy 1e-3 mm, as far as the search finds the best position.
    //
    // normal  of the floor there, unit, upward
    // resolution  mm: heights above this may be inexact
    double lowest_over(Vec3d place, Vec3d normal, double resolution);

private:
    struct Cutter {
        toolpath::Tool tool;
        toolpath::Tool grown_tool;  // the tool, grown
        std::optional<drop_cutter::DropCutter> floor;
        std::optional<drop_cutter::LowestPositionSearch> search;
        std::optional<drop_cutter::LowestPositionSearch> on_samples;  // of a ball
        int in_vain;  // places in a row where that did not decide
        int skipped;  // places where it was left out then
    };
    bool within_walls(const Cutter& cutter, double x, double y) const;
    drop_cutter::LowestPositionSearch::DroppedTool drop_on_samples(const Cutter& cutter,
                                                                   double x,
                                                                   double y) const;
    drop_cutter::LowestPositionSearch::DroppedTool drop_at(Cutter& cutter, double x, double y);

    const std::vector<nurbs::Surface>& surfaces_;
    const std::vector<std::array<Vec3d, 3>>& mesh_;
    const std::vector<WallDistance>& walls_;
    const FloorSamples& samples_;
    double path_clearance_;
    std::optional<part_model::PartModel> model_;  // of the mesh
    std::vector<Cutter> cutters_;
};

}  // namespace cusp::verify
