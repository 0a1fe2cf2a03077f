// Reachable height over a point that the ball cannot touch: the lowest position of the tool in
// valleys, at concave edges and under overhangs.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "host_tools/cam/finishing/gouge_free_path.hpp"
#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/drop_cutter/lowest_position_search.hpp"

namespace cusp::finishing {

// `LowestPositionSearch` for passes. Its drops are upper bounds, a little high; the tip returned is
// dropped exactly. A search, not a proof. Not for use by two threads at once.
class ReachableHeight {
public:
    // surfaces  of the fitter's model; empty if it is a mesh
    // pitch     mm, of the grid
    // accuracy  mm: how much too high drops may be
    ReachableHeight(const std::vector<nurbs::Surface>& surfaces,
                    const GougeFreePathFitter& path_fitter,
                    double pitch,
                    double accuracy);
    // For another thread: shares the surfaces, their trims and drops, searches on its own.
    ReachableHeight(const ReachableHeight& other);
    ReachableHeight& operator=(const ReachableHeight&) = delete;

    struct Position {
        Vec3d tip;
        double height;  // mm: z that this tip leaves straight above or below the point
    };
    // exact_below  mm: heights above this and their tips may be inexact; a low one saves most of
    //              the time
    //
    // None where the tool has no position over the point.
    std::optional<Position> lowest_over(Vec3d place, double exact_below);

    // As lowest_over(), for tips that gouge no edge from the side; none where no such tip is found
    // that leaves less than `exact_below`.
    //
    // near  the answer of lowest_over(), which gouges an edge
    std::optional<Position> lowest_clear_of_edges(Vec3d place,
                                                  const Position& near,
                                                  double exact_below);

    double pitch() const { return search_.pitch(); }

    // Number of drops made, those in vain included: they take most of the time.
    std::size_t drops_made() const { return drops_made_; }

    // Drops on the grids, which the copies of one ReachableHeight share.
    struct Drops {
        drop_cutter::LowestPositionSearch::Nodes any;
        drop_cutter::LowestPositionSearch::Nodes clear_of_edges;
    };
    // The drops that this one made and does not share yet.
    Drops take_drops() { return {search_.take_nodes(), search_clear_of_edges_.take_nodes()}; }
    // Those, copied; and the first ones of another copy, which take_drops() leaves out.
    Drops drops() const { return {search_.nodes(), search_clear_of_edges_.nodes()}; }
    void begin_with(Drops drops);
    // Shares drops of a copy, up to a number; of those at one node the first ones given. No copy may
    // search meanwhile.
    void share(Drops drops);

private:
    // True if tips that gouge rims and creases from the side are excluded.
    enum class Edges : std::uint8_t { kIgnored, kMovedClear };

    void use(std::shared_ptr<Drops> drops);
    drop_cutter::LowestPositionSearch::DroppedTool drop_at(double x, double y, Edges edges);
    std::optional<Position> exact_over(Vec3d place, double x, double y, Edges edges) const;
    std::optional<Position> beside(Vec3d place, Vec3d brink, double exact_below, Edges edges);
    std::optional<Position> exactly(const drop_cutter::LowestPositionSearch::Position& found,
                                    Vec3d place,
                                    double exact_below,
                                    Edges edges);

    // Made when first needed, which is never for most models.
    struct SharedFloor {
        std::once_flag made;
        std::optional<drop_cutter::DropCutter> cutter;  // never queried
    };

    const std::vector<nurbs::Surface>& surfaces_;
    const GougeFreePathFitter& path_fitter_;
    std::shared_ptr<SharedFloor> shared_floor_{std::make_shared<SharedFloor>()};
    std::shared_ptr<Drops> shared_drops_;
    std::optional<drop_cutter::DropCutter> floor_;
    double accuracy_;
    double radius_;
    double contact_radius_;  // mm: of the ball grown by the band's offset, which touches the model
    mutable std::size_t drops_made_{};
    drop_cutter::LowestPositionSearch search_;
    drop_cutter::LowestPositionSearch search_clear_of_edges_;
};

}  // namespace cusp::finishing
