// The common part of strategies that finish surfaces with a ball: checks of the job, the model, and
// the conversion of dense passes to a planned operation.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/cam/finishing/finishing.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::adaptive_isocurve {

// Throws InputError where the model is higher than the clearance height of rapid moves.
void check_clearance(const job::Job& job,
                     const job::Operation& operation,
                     const part_model::PartModel& model);

class SurfaceOperation {
public:
    // surfaces  empty: the operation's mesh, for which a tolerance is always one-sided
    //
    // Throws InputError for a job that it cannot plan: another tool than a ball, a boundary, a
    // surface without area, a part higher than the clearance height.
    SurfaceOperation(const job::Job& job,
                     const job::Operation& operation,
                     std::vector<nurbs::Surface> surfaces);

    const std::vector<nurbs::Surface>& surfaces() const { return surfaces_; }
    const part_model::PartModel& model() const { return *model_; }
    finishing::GougeFreePathFitter& path_fitter() { return *path_fitter_; }
    const finishing::GougeFreePathFitter& path_fitter() const { return *path_fitter_; }

    // The maximum distance of the path off the surface, mm.
    double outward() const;

    // Fits the pass in the form that the job requests. Returns points of the path that will be cut;
    // it stays within path_off() of the lines through them.
    //
    // exact          for output as NURBS: the pass as a cubic within the band, used if it is proved
    //                free of gouges
    // cc_parameters  the contacts at the dense points, if known: a quicker proof of lines
    finishing::Points add_pass(const finishing::Points& wanted,
                               const std::optional<nurbs::Curve>& exact = std::nullopt,
                               const finishing::CcParameterList& cc_parameters = {});
    // add_pass() in two steps: several threads may fit, one of them adds.
    struct FittedPass {
        finishing::SurfacePass pass;
        finishing::Points points;  // of the path that will be cut; empty: no pass
        bool moved{};              // off an edge that the tool would gouge
        double least_clearance{};
    };
    // queries  of the calling thread's part of a loop, if any: see GougeFreePathFitter::set_part()
    FittedPass fitted_pass(
        const finishing::Points& wanted,
        const std::optional<nurbs::Curve>& exact = std::nullopt,
        const finishing::CcParameterList& cc_parameters = {},
        const part_model::PartModel::SharedQueries::Part* queries = nullptr) const;
    finishing::Points add(FittedPass fitted);
    // As fitted_pass(), for output as lines and a tool proved clear all along; otherwise none.
    std::optional<FittedPass> fitted_clear_pass(
        const finishing::Points& dense, const finishing::CcParameterList& cc_parameters) const;
    double path_off() const;
    // True if some pass was moved off an edge that the tool would gouge from the side.
    bool moved_off_edges() const { return moved_off_edges_; }

    // Links all passes. `spacing` (mm) is the approximate distance of neighbours.
    toolpath::PlannedOperation finish(double spacing, double scallop_bound);

private:
    void check_tool() const;
    void check_form() const;
    void check_surfaces();
    void keep_in_stock(double linked, toolpath::OperationStats& stats);
    finishing::Points path_of(const finishing::SurfacePass& pass) const;

    const job::Job& job_;
    const job::Operation& operation_;
    std::vector<nurbs::Surface> surfaces_;
    std::unique_ptr<part_model::PartModel> model_;
    std::unique_ptr<finishing::GougeFreePathFitter> path_fitter_;
    std::vector<finishing::SurfacePass> passes_;
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

// mm of walls beside which a ball has nothing of the part below.
void report_walls_over_nothing(toolpath::OperationStats& stats, double length);

}  // namespace cusp::adaptive_isocurve
