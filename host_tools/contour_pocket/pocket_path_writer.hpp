// Cuts the passes of a cleared region on a floor: drops each onto it, enters, links and retracts.
#pragma once

#include <functional>
#include <optional>

#include "host_tools/clearing/axial_depth_tracker.hpp"
#include "host_tools/clearing/clearing.hpp"
#include "host_tools/contour_pocket/cl_path.hpp"
#include "host_tools/contour_pocket/cl_path_writer.hpp"
#include "host_tools/job/job.hpp"

namespace cusp::contour_pocket {

// Stock that roughing left beside some passes, up to its top: too thin for the stock map to show.
struct StockBesidePasses {
    std::vector<bool> passes;  // which; empty: none
    double top{};              // z of the stock
    // z, downward: such passes are cut at these first, as far as they lie deeper; those that are
    // linked to each other together.
    std::vector<double> heights;
};

struct CutSettings {
    ClPathSettings path_settings;
    job::EntryKind entry{job::EntryKind::kAuto};
    double wall_clearance{};  // mm: least distance of the tool's centre from the walls
    // Passes that nowhere go deeper than this are left out (cut by the layer above).
    double skip_above{kUnbounded};
    // Which passes have paths that are cut at several heights (flattened()); empty: none.
    std::vector<bool> repeated;
    StockBesidePasses stock_beside;
    // Fraction of max_depth that a pass may cut where the stock height is known.
    double depth_share{1.0};
    // Retracts that may have been made at the end, the last one included; no fewer than there are
    // entries. Where entries need the rest, other passes are reached above the stock, however far.
    int retracts{};
    // Where entries start, from the height of the pass there.
    std::function<EntryHeights(double)> entry_heights;
    // Where given, called with the share of the passes that is written.
    std::function<void(double)> progress;
};

// Where the tool's axis may be that keeps `wall_clearance` mm off the walls but for rounding.
offset::Region2d reach_of(const offset::RegionOffset& walls, double wall_clearance);

class PocketPathWriter {
public:
    // walls  of the pocket
    // depth  where given, passes that would cut too deep are cut at levels over them first, and
    //        entries start over the stock; passes that have no link are reached by short ways above
    //        it
    PocketPathWriter(const job::Operation& operation,
                     const drop_cutter::DropCutter& floor,
                     const offset::RegionOffset& walls,
                     ClPathWriter& moves,
                     clearing::AxialDepthTracker* depth)
        : operation_{operation}, floor_{floor}, walls_{walls}, moves_{moves}, depth_{depth}
    {
    }

    // Throws InputError where a pass leaves the floor. The tool stays where the last pass ends.
    void cut(const clearing::ClearedRegion& cleared, const CutSettings& settings);

    // Takes the tool up from its last pass.
    void end();

    // mm; 0, or negative by how much some move may cut into the floor.
    double least_clearance() const { return least_clearance_; }

private:
    // A pass with its path on the floor.
    struct ProjectedPass {
        clearing::ClearingPass pass;
        ClPathSettings settings;
        ClPath path;
    };
    ProjectedPass project_pass(const clearing::ClearingPass& pass,
                               const CutSettings& settings,
                               bool repeated);
    bool too_deep(const ClPath& path, const CutSettings& settings) const;
    bool link(const ProjectedPass& projected, const CutSettings& settings);
    bool link_above_stock(const ProjectedPass& projected, const CutSettings& settings);
    bool link_around(const ProjectedPass& projected, const CutSettings& settings);
    bool is_shorter_than_retract(const std::vector<offset::Edge>& way) const;
    void follow_above(const std::vector<offset::Edge>& way, double z, const CutSettings& settings);
    void begin(const ProjectedPass& projected, const CutSettings& settings);
    void return_over(const std::vector<clearing::ClearingPass>& passes,
                     std::size_t from,
                     std::size_t to,
                     const CutSettings& settings);
    void cut_beside_stock(std::vector<clearing::ClearingPass>& passes, const CutSettings& settings);
    void cut_final(clearing::ClearingPass& pass, const CutSettings& settings, bool repeated);
    void cut_pass(clearing::ClearingPass& pass, const CutSettings& settings, bool repeated);
    ProjectedPass cut_above(const ProjectedPass& deep, const CutSettings& settings, bool repeated);
    ClPath project(const std::vector<offset::Edge>& plan, const ClPathSettings& path_settings);
    void enter(const ProjectedPass& cut, const CutSettings& settings);
    void track_moves();
    std::optional<double> allowed_height_over(const ClPath& path,
                                              const CutSettings& settings) const;
    double stock_top_over(const ClPath& path) const;
    double stock_top_around(Vec2d start, double radius) const;

    const job::Operation& operation_;
    const drop_cutter::DropCutter& floor_;
    const offset::RegionOffset& walls_;
    ClPathWriter& moves_;
    clearing::AxialDepthTracker* depth_;
    double least_clearance_{0.0};
    int allowed_retracts_{0};  // until now
    std::optional<offset::Region2d> reach_;
};

}  // namespace cusp::contour_pocket
