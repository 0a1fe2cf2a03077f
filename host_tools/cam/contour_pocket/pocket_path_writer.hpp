// Writes the passes of a cleared region on a floor: projects each onto it, enters, links and
// retracts.
#pragma once

#include <functional>
#include <optional>

#include "host_tools/cam/cl_path/cl_path.hpp"
#include "host_tools/cam/clearing/axial_depth_tracker.hpp"
#include "host_tools/cam/clearing/clearing.hpp"
#include "host_tools/cam/contour_pocket/cl_path_writer.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::contour_pocket {

// Stock left by roughing beside some passes, up to its top: too thin to appear in the stock height
// map.
struct StockBesidePasses {
    std::vector<bool> passes;  // which passes; empty: none
    double top{};              // z of the stock
    // z, descending: such passes are cut at these heights first, if deeper; linked passes together.
    std::vector<double> heights;
};

struct CutSettings {
    cl_path::ClPathSettings path_settings;
    job::EntryKind entry{job::EntryKind::kAuto};
    double wall_clearance{};  // mm: least distance of the tool's centre from the walls
    // Passes that nowhere go below this z are omitted (the layer above has cut them).
    double skip_above{kUnbounded};
    // Which passes are cut at several heights (flattened()); empty: none.
    std::vector<bool> repeated;
    StockBesidePasses stock_beside;
    // Passes that roughing has cut whole; empty: none.
    std::vector<bool> skipped;
    // Rapid moves over passes that are not `repeated` end above the stock height map, which may miss thin
    // stock beside walls; else above entry_heights.
    bool rapid_to_stock{};
    // Fraction of max_depth that a pass may cut where the stock height is known.
    double depth_share{1.0};
    // Limit of the retracts up to the end, the last one included; at least the number of entries.
    // If entries need the remaining ones, links above the stock may have any length.
    int retracts{};
    // Heights where entries start, from the height of the pass there.
    std::function<EntryHeights(double)> entry_heights;
    // If given, called with the share of passes written.
    std::function<void(double)> progress;
};

// Region of the tool's axis: at least `wall_clearance` mm from the walls, except for rounding.
offset::Region2d reach_of(const offset::RegionOffset& walls, double wall_clearance);

class PocketPathWriter {
public:
    // walls  of the pocket
    // depth  if given, passes that would cut too deep are first cut at levels above them, and
    //        entries start above the stock; passes without a link are reached by short links above
    //        it
    PocketPathWriter(const job::Operation& operation,
                     const drop_cutter::DropCutter& floor,
                     const offset::RegionOffset& walls,
                     ClPathWriter& moves,
                     clearing::AxialDepthTracker* depth)
        : operation_{operation}, floor_{floor}, walls_{walls}, moves_{moves}, depth_{depth}
    {
    }

    // Errors: InputError if a pass leaves the floor. The tool stays at the end of the last pass.
    void cut(const clearing::ClearedRegion& cleared, const CutSettings& settings);

    // Retracts from the last pass.
    void end();

    // mm: 0, or the negative of the deepest possible gouge of a move.
    double least_clearance() const { return least_clearance_; }

private:
    // A pass with its path on the floor.
    struct ProjectedPass {
        clearing::ClearingPass pass;
        cl_path::ClPathSettings settings;
        cl_path::ClPath path;
    };
    ProjectedPass project_pass(const clearing::ClearingPass& pass,
                               const CutSettings& settings,
                               bool repeated);
    bool too_deep(const cl_path::ClPath& path, const CutSettings& settings) const;
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
    cl_path::ClPath project(const std::vector<offset::Edge>& plan,
                            const cl_path::ClPathSettings& path_settings);
    void enter(const ProjectedPass& cut, const CutSettings& settings);
    void track_moves();
    std::optional<double> allowed_height_over(const cl_path::ClPath& path,
                                              const CutSettings& settings) const;
    double stock_top_over(const cl_path::ClPath& path) const;
    double stock_top_around(Vec2d start, double radius) const;

    const job::Operation& operation_;
    const drop_cutter::DropCutter& floor_;
    const offset::RegionOffset& walls_;
    ClPathWriter& moves_;
    clearing::AxialDepthTracker* depth_;
    double least_clearance_{0.0};
    int allowed_retracts_{0};  // up to now
    std::optional<offset::Region2d> reach_;
};

}  // namespace cusp::contour_pocket
