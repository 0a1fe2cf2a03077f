// Reachable height of the tools over single points of the floor, where the grid of heights is too
// coarse for the verdict.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/drop_cutter/lowest_position_search.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/judge/verify/floor_samples.hpp"
#include "host_tools/judge/verify/pocket_boundaries.hpp"

namespace cusp::verify {

// Drops each tool on the surfaces, starting from the best places of a grid with a pitch of an
// eighth of the radius (`LowestPositionSearch`). If the samples of the floor alone prove that a
// ball gets no lower, the surfaces are skipped. Not for use by two threads at once.
class ToolAccess {
public:
    // samples         points of the floor
    // path_clearance  mm: distance that the tools have to keep from the floor
    ToolAccess(const std::vector<nurbs::Surface>& surfaces,
               const std::vector<std::array<Vec3d, 3>>& mesh,
               const std::vector<toolpath::Tool>& tools,
               const PocketBoundaries& walls,
               const FloorSamples& samples,
               double path_clearance);
    ToolAccess(const ToolAccess&) = delete;  // its searches drop tools of its own
    ToolAccess& operator=(const ToolAccess&) = delete;

    // The lowest height that the tools can leave vertically above or below the point; infinite
    // where none can come. Accuracy 1e-3 mm, as far as the search finds the best position.
    //
    // normal      of the floor there, a unit vector, upward
    // exact_below  mm: heights above this may be inexact
    double lowest_over(Vec3d place, Vec3d normal, double exact_below);

private:
    struct Cutter {
        toolpath::Tool tool;
        toolpath::Tool grown_tool;  // the tool, grown
        std::optional<drop_cutter::DropCutter> floor;
        std::optional<drop_cutter::LowestPositionSearch> search;
        std::optional<drop_cutter::LowestPositionSearch> on_samples;  // of a ball
        int failures;  // consecutive points that it did not decide
        int skipped;   // points that skipped it since
    };
    bool within_walls(const Cutter& cutter, double x, double y) const;
    drop_cutter::LowestPositionSearch::DroppedTool drop_on_samples(const Cutter& cutter,
                                                                   double x,
                                                                   double y) const;
    drop_cutter::LowestPositionSearch::DroppedTool drop_at(Cutter& cutter, double x, double y);

    // The lowest tip of a cone: the best of drops on a grid round the place, then of ever smaller steps from there.
    double lowest_of_cone(Cutter& cutter, Vec3d place, Vec2d touching);

    const std::vector<nurbs::Surface>& surfaces_;
    const std::vector<std::array<Vec3d, 3>>& mesh_;
    const PocketBoundaries& walls_;
    const FloorSamples& samples_;
    double path_clearance_;
    std::optional<part_model::PartModel> model_;  // of the mesh
    std::vector<Cutter> cutters_;
};

}  // namespace cusp::verify
