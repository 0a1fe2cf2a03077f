// The check of a mesh for a ball: proved where the ball can touch, and where it gets no lower.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_tools/cam/finishing/mesh_check.hpp"
#include "host_tools/cam/finishing/mesh_traces.hpp"
#include "host_tools/cam/finishing/scallop_at_point.hpp"
#include "host_tools/cam/finishing/uncut_walls.hpp"
#include "host_tools/cam/finishing/work_in_shares.hpp"

namespace cusp::finishing {

// The counterpart of `ScallopCheck` for facets. Vertical ones, and those that hardly lean, are checked by
// `WallSide`: where the side of a ball reaches them that rests on something.
//
// Over a steep facet the stock may be high and still thin: it counts as thick as it is vertically,
// multiplied by the cosine of the slope, or as it is along the normal, whichever is less.
//
// Long searches run on several threads, each with a copy that shares the passes; which copy looks at which
// cell does not depend on the number of threads.
class MeshScallopCheck : public MeshCheck {
public:
    // As mesh_check()
    MeshScallopCheck(const std::vector<Corners>& triangles,
                     const GougeFreePathFitter& path_fitter,
                     double scallop,
                     double path_off);

    void add(const Points& tips) override { places_.add(tips); }
    bool is_covered(Vec3d place, Vec3d normal, double share) const override
    {
        return places_.is_covered(place, normal, share);
    }
    double step() const override { return places_.step(); }
    void check() override;
    void add_missing_passes(const std::function<void(const Points&)>& cut) override;
    void measure_left() override;
    MeshLeft left() const override;
    void share_out(std::size_t count,
                   const std::function<void(const MeshCheck&, std::size_t)>& work) override;

private:
    using Cell = FacetCell;
    // A cell that the tool can't touch is kSettled if it has no lower position over it, else kBlocked.
    enum class Verdict : std::uint8_t { kCovered, kHalve, kBlocked, kSettled, kUncovered };

    // A copy for another thread: without cells, with the passes of this one.
    struct ForThread {};
    MeshScallopCheck(const MeshScallopCheck& other, ForThread tag);
    using CopyWork = std::function<void(MeshScallopCheck&, std::size_t)>;
    ReachableHeight::Drops work_at(OpenShare& share, const CopyWork& work) const;
    void work_of_copies(std::size_t count, const CopyWork& work);
    // The main work of a copy: drops, and cells looked at.
    std::size_t effort() const { return places_.drops_made() + judged_; }
    double left_over(const Cell& cell) const;
    void check_cell(const Cell& cell, int depth);
    Verdict judge(const Cell& cell) const;
    Verdict judge_steep(const Cell& cell, double longest) const;
    bool is_upright(Vec3d normal) const;
    std::vector<WallFacet> vertical_facets() const;
    Points trace_level(const MeshPlace& from) const;
    bool is_hidden(Vec3d point) const;
    bool is_hidden(const MeshPlace& at) const;
    Verdict judge_blocked(const Cell& cell, double longest) const;
    bool settled(const Cell& cell, double longest) const;
    std::optional<MeshPlace> uncovered_point(const Cell& cell) const;
    bool may_be_uncovered(const Cell& cell) const;
    std::optional<Vec3d> missing_tip(const MeshPlace& at) const;
    struct Neighbours;
    std::vector<Cell> cut_missing(const std::vector<Cell>& open,
                                  const std::function<void(const Points&)>& cut);
    std::vector<Neighbours> neighbours_of(const std::vector<Cell>& open) const;
    Points longest_trace(const MeshPlace& from) const;

    const std::vector<Corners>& triangles_;
    const GougeFreePathFitter& path_fitter_;
    const std::vector<nurbs::Surface> no_surfaces_;
    double scallop_;
    double path_off_;
    ScallopAtPoint places_;
    std::vector<Cell> uncovered_;
    UncutWalls walls_;
    double most_left_{};
    double over_nothing_{};
    double blocked_area_{};
    bool overflowed_{};
    mutable std::size_t judged_{};  // cells
    bool checking_{};
    mutable std::vector<std::uint32_t> near_;
};

}  // namespace cusp::finishing
