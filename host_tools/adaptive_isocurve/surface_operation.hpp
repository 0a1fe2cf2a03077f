// What the strategies that run a ball over surfaces share: checks of the job, the model, the way
// from dense passes to a planned operation.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/finishing/gouge_free_path.hpp"
#include "host_tools/finishing/pass_links.hpp"
#include "host_tools/job/job.hpp"

namespace cusp::adaptive_isocurve {

// Error: the model is higher than rapid moves are made.
void check_clearance(const job::Job& job,
                     const job::Operation& operation,
                     const part_model::PartModel& model);

class SurfaceOperation {
public:
    // surfaces  none: the operation's mesh, on which a tolerance is one-sided always
    //
    // Throws InputError for a job this cannot do: another tool than a ball, a boundary, a surface
    // without area, a part that rises over the clearance height.
    SurfaceOperation(const job::Job& job,
                     const job::Operation& operation,
                     std::vector<nurbs::Surface> surfaces);

    const std::vector<nurbs::Surface>& surfaces() const { return surfaces_; }
    const part_model::PartModel& model() const { return *model_; }
    finishing::GougeFreePathFitter& path_fitter() { return *path_fitter_; }

    // How far the path may lie off the surface at most, mm.
    double outward() const;
    // What the scallop leaves for the ridges between passes, mm.
    double allowed_scallop() const;

    // Fits the pass in the form the job asks for. Returns points of the path that will be cut,
    // which stays within `path_off()` of the lines through them.
    //
    // exact  where the job asks for NURBS: the same pass as a cubic within the band, taken as it is
    //        where it is proved to be free
    // cc_parameters  where the tool touches at the dense points, if known: makes the proof of lines
    //                quick
    finishing::Points add_pass(const finishing::Points& wanted,
                               const std::optional<nurbs::Curve>& exact = std::nullopt,
                               const finishing::CcParameterList& cc_parameters = {});
    // The same where the job asks for lines and the tool is proved to be free all along; none, and
    // no pass, where not.
    std::optional<finishing::Points> add_clear_pass(
        const finishing::Points& dense, const finishing::CcParameterList& cc_parameters);
    double path_off() const;
    // Whether some pass stands off a rim or crease by more than its place on the surface asks for.
    bool moved_off_edges() const { return moved_off_edges_; }
    std::size_t pass_count() const { return passes_.size(); }

    // Links all passes; `spacing` (mm) is about the distance of neighbours.
    toolpath::PlannedOperation finish(double spacing, double scallop_bound);

private:
    void check_tool() const;
    void check_form() const;
    void check_surfaces();
    finishing::Points path_of(const finishing::SurfacePass& pass) const;

    const job::Job& job_;
    const job::Operation& operation_;
    std::vector<nurbs::Surface> surfaces_;
    std::unique_ptr<part_model::PartModel> model_;
    std::unique_ptr<finishing::GougeFreePathFitter> path_fitter_;
    std::vector<finishing::SurfacePass> passes_;
    bool moved_off_edges_{};
    int upright_{};  // surfaces
};

// Warns of places that may keep more than the scallop.
//
// uncovered  how many stay uncovered
// unseen  whether the look for them ended early
void report_uncovered_points(toolpath::OperationStats& stats, std::size_t uncovered, bool unseen);

}  // namespace cusp::adaptive_isocurve
