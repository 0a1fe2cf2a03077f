// How low a ball gets over a place that it can't touch: the best position of the tool in valleys,
// concave edges and under overhangs.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/drop_cutter/drop_cutter.hpp"
#include "host_tools/drop_cutter/lowest_position_search.hpp"
#include "host_tools/finishing/gouge_free_path.hpp"

namespace cusp::finishing {

// `LowestPositionSearch` for passes: its drops are bounds from above, a little high; the answer's
// is exact. A search, not a proof.
class ReachableHeight {
public:
    // surfaces  of the model that the passes are certified on; none: it is a mesh
    // pitch     mm, of the grid
    // accuracy  mm: how high drops may be
    ReachableHeight(const std::vector<nurbs::Surface>& surfaces,
                    const GougeFreePathFitter& path_fitter,
                    double pitch,
                    double accuracy);
    ReachableHeight(const ReachableHeight&) = delete;
    ReachableHeight& operator=(const ReachableHeight&) = delete;

    struct Position {
        Vec3d tip;
        double height;  // mm: what this tip leaves straight above or below the place
    };
    // resolution  mm: heights above this and their tips may be inexact; a low one
    //             saves
    //        most of the time
    //
    // None where the tool can't stand over the place.
    std::optional<Position> lowest_over(Vec3d place, double resolution);

    // As lowest_over() for a tool that keeps clear of edges as passes do; none where no tip is
    // found that leaves less than `resolution`.
    //
    // near  `lowest_over`'s answer, that does not
    std::optional<Position> lowest_clear_of_edges(Vec3d place,
                                                  const Position& near,
                                                  double resolution);

private:
    // Whether the tool keeps clear of rims and creases.
    enum class Edges : std::uint8_t { kIgnored, kMovedClear };

    drop_cutter::LowestPositionSearch::DroppedTool drop_at(double x, double y, Edges edges);
    std::optional<Position> exact_over(Vec3d place, double x, double y, Edges edges) const;
    std::optional<Position> beside(Vec3d place, Vec3d brink, double resolution, Edges edges);
    std::optional<Position> exactly(const drop_cutter::LowestPositionSearch::Position& found,
                                    Vec3d place,
                                    double resolution,
                                    Edges edges);

    const std::vector<nurbs::Surface>& surfaces_;
    const GougeFreePathFitter& path_fitter_;
    std::optional<drop_cutter::DropCutter> floor_;
    double accuracy_;
    double radius_;
    double contact_radius_;  // mm: of a ball that touches what the tool keeps `offset` off
    drop_cutter::LowestPositionSearch search_;
    drop_cutter::LowestPositionSearch search_clear_of_edges_;
};

}  // namespace cusp::finishing
