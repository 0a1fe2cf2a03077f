// The common part of strategies that finish surfaces: checks of the job, the model, and
// the conversion of dense passes to a planned operation.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host_tools/cam/finishing/finish_area.hpp"
#include "host_tools/cam/finishing/finishing.hpp"
#include "host_tools/cam/finishing/mesh_check.hpp"
#include "host_tools/cam/finishing/passes_in_stock.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::finishing {

// Throws InputError where the model is higher than the clearance height of rapid moves.
void check_clearance(const job::Job& job,
                     const job::Operation& operation,
                     const part_model::PartModel& model);

// An operation that finishes with another end than a ball, over triangles in place of its surfaces. How
// far they are off is taken from the tolerance and the scallop.
job::Operation faceted(const job::Operation& operation);

class SurfaceOperation {
public:
    // surfaces  empty: the operation's mesh, for which a tolerance is always one-sided
    //
    // The scallop is proved, and passes are made, in the operation's FinishArea: its boundary, islands,
    // slopes and heights.
    //
    // Throws InputError for a job that it cannot plan: another end than a ball over surfaces (see
    // faceted()), a surface without area, a part higher than the clearance height.
    SurfaceOperation(const job::Job& job,
                     const job::Operation& operation,
                     std::vector<nurbs::Surface> surfaces);

    const std::vector<nurbs::Surface>& surfaces() const { return surfaces_; }
    const part_model::PartModel& model() const { return *model_; }
    GougeFreePathFitter& path_fitter() { return *path_fitter_; }
    const GougeFreePathFitter& path_fitter() const { return *path_fitter_; }

    // Passes go on the area that is proved, and a little beyond its border.
    const FinishArea& area() const { return path_fitter_->area(); }

    // The parts of dense tips, each from its first to its last, that touch the model in the area.
    //
    // cc_parameters  of the tips if known; else the tool is dropped at each
    using Range = std::pair<std::size_t, std::size_t>;
    std::vector<Range> ranges_in_area(const Points& tips,
                                      const CcParameterList& cc_parameters) const;
    // The parts of a crease: there the tool touches two places, of which one is in the area.
    std::vector<Points> creases_in_area(const Points& crease) const;

    // The maximum distance of the path off the surface, mm.
    double outward() const;

    // Fits the pass in the form that the job requests. Returns points of the path that will be cut;
    // it stays within path_off() of the lines through them.
    //
    // exact          for output as NURBS: the pass as a cubic within the band, used if it is proved
    //                free of gouges
    // cc_parameters  the contacts at the dense points, if known: a quicker proof of lines
    Points add_pass(const Points& wanted,
                    const std::optional<nurbs::Curve>& exact = std::nullopt,
                    const CcParameterList& cc_parameters = {});
    // add_pass() in two steps: several threads may fit, one of them adds.
    struct FittedPass {
        SurfacePass pass;
        Points points;  // of the path that will be cut; empty: no pass
        bool moved{};   // off an edge that the tool would gouge
        double least_clearance{};
    };
    // queries  of the calling thread's part of a loop, if any: see GougeFreePathFitter::set_part()
    FittedPass fitted_pass(
        const Points& wanted,
        const std::optional<nurbs::Curve>& exact = std::nullopt,
        const CcParameterList& cc_parameters = {},
        const part_model::PartModel::SharedQueries::Part* queries = nullptr) const;
    Points add(FittedPass fitted);
    // As fitted_pass(), for output as lines and a tool proved clear all along; otherwise none.
    std::optional<FittedPass> fitted_clear_pass(const Points& dense,
                                                const CcParameterList& cc_parameters) const;
    double path_off() const;
    // True if some pass was moved off an edge that the tool would gouge from the side.
    bool moved_off_edges() const { return moved_off_edges_; }

    // Parts of passes that are idle are left out: another tool has cut there.
    void leave_out(IsIdle is_idle) { is_idle_ = std::move(is_idle); }

    // Links all passes. `spacing` (mm) is the approximate distance of neighbours, `lead_in` (mm) the
    // radius of level entries and exits.
    toolpath::PlannedOperation finish(double spacing, double scallop_bound, double lead_in = 0);

private:
    void check_tool() const;
    std::vector<Range> ranges_where(std::size_t count,
                                    const std::function<bool(std::size_t)>& holds) const;
    void check_form() const;
    void check_surfaces();
    void keep_in_stock(double linked, toolpath::OperationStats& stats);
    void leave_out_idle(double linked);
    Points path_of(const SurfacePass& pass) const;

    const job::Job& job_;
    const job::Operation& operation_;
    std::vector<nurbs::Surface> surfaces_;
    std::unique_ptr<part_model::PartModel> model_;
    std::unique_ptr<GougeFreePathFitter> path_fitter_;
    std::vector<SurfacePass> passes_;
    IsIdle is_idle_;  // empty: nowhere
    bool moved_off_edges_{};
    int upright_{};  // number of vertical surfaces
};

// Adds the count and a warning of what passes leave beside edges that they keep off.
//
// beside_edges  mm: ScallopCheck::left_beside_edges(); no more than the scallop's bound: nothing is
//               added
void report_left_beside_edges(toolpath::OperationStats& stats,
                              double beside_edges,
                              double scallop_bound);

// Adds warnings of points that may keep more than the scallop.
//
// uncovered  number of uncovered cells
// unseen     whether the check ended early
void report_uncovered_points(toolpath::OperationStats& stats, std::size_t uncovered, bool unseen);

// Adds a warning of ground that the tool can't touch, and what was measured there.
void report_blocked(toolpath::OperationStats& stats,
                    const MeshLeft& left,
                    const toolpath::Tool& tool);

// mm of walls beside which a ball has nothing of the part below.
void report_walls_over_nothing(toolpath::OperationStats& stats, double length);

}  // namespace cusp::finishing
