// How low the tools get over single places of the floor: where the verdict hangs on it, the grid of
// heights is too coarse to say.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host_tools/clearing/reach_search.hpp"
#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/surface_offset/surface_model.hpp"
#include "host_tools/toolpath/toolpath.hpp"
#include "host_tools/verify/floor_samples.hpp"
#include "host_tools/verify/wall_distance.hpp"

namespace cusp::host {

// Drops of each tool on the surfaces themselves, improved from the best places of a grid an eighth
// of the radius fine (`ReachSearch`). Where a ball finds nothing lower on points of the floor
// alone, there is nothing, and no surface is asked. Not for use by two threads at once.
class FloorReach {
public:
    // samples   points of the floor
    // keep_off  mm: how far the tools have to stay off the floor
    FloorReach(const std::vector<Surface>& surfaces,
               const std::vector<std::array<Vec3d, 3>>& mesh,
               const std::vector<Tool>& tools,
               const std::vector<WallDistance>& walls,
               const FloorSamples& samples,
               double keep_off);
    FloorReach(const FloorReach&) = delete;  // its searches drop tools of its own
    FloorReach& operator=(const FloorReach&) = delete;

    // Returns the height that the tools leave at best straight over the place; infinite where none
    // can come. Accuracy 1e-3 mm, as far as the search finds the best position.
    //
    // normal  of the floor there, unit, upward
    // worth   mm: heights above this are not told apart
    double lowest_over(Vec3d place, Vec3d normal, double worth);

private:
    struct Cutter {
        Tool tool;
        Tool kept_off;  // the tool, grown
        std::optional<TipFloor> floor;
        std::optional<ReachSearch> search;
        std::optional<ReachSearch> on_samples;  // of a ball
        int in_vain;                            // places in a row where that was no help
        int skipped;                            // places where it was not asked then
    };
    bool within_walls(const Cutter& cutter, double x, double y) const;
    ReachSearch::Rest dropped_on_samples(const Cutter& cutter, double x, double y) const;
    ReachSearch::Rest dropped(Cutter& cutter, double x, double y);

    const std::vector<Surface>& surfaces_;
    const std::vector<std::array<Vec3d, 3>>& mesh_;
    const std::vector<WallDistance>& walls_;
    const FloorSamples& samples_;
    double keep_off_;
    std::optional<SurfaceModel> model_;  // of the mesh
    std::vector<Cutter> cutters_;
};

}  // namespace cusp::host
