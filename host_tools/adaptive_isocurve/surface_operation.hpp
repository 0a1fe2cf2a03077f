// What the strategies that run a ball over surfaces share: checks of the job, the model, the way
// from dense passes to a planned operation.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/import/job.hpp"
#include "host_tools/surface_passes/certified_pass.hpp"
#include "host_tools/surface_passes/pass_links.hpp"

namespace cusp::host {

// Error: the model is higher than rapid moves are made.
void check_clearance(const Job& job, const Operation& operation, const SurfaceModel& model);

class SurfaceOperation {
public:
    // surfaces  none: the operation's mesh, on which a tolerance is one-sided always
    //
    // Throws InputError for a job this cannot do: another tool than a ball, a boundary, a surface
    // without area, a part that rises over the clearance height.
    SurfaceOperation(const Job& job, const Operation& operation, std::vector<Surface> surfaces);

    const std::vector<Surface>& surfaces() const { return surfaces_; }
    const SurfaceModel& model() const { return *model_; }
    CertifiedPasses& certified() { return *certified_; }

    // How far the path may lie off the surface at most, mm.
    double outward() const;
    // What the scallop leaves for the ridges between passes, mm.
    double ridge_allowed() const;

    // Fits the pass in the form the job asks for. Returns points of the path that will be cut,
    // which stays within `path_off()` of the lines through them.
    //
    // exact  where the job asks for NURBS: the same pass as a cubic within the band, taken as it is
    //        where it is proved to be free
    // feet   where the tool touches at the dense points, if known: makes the proof of lines quick
    Points add_pass(const Points& wanted,
                    const std::optional<Curve>& exact = std::nullopt,
                    const Feet& feet = {});
    // The same where the job asks for lines and the tool is proved to be free all along; none, and
    // no pass, where not.
    std::optional<Points> add_free_pass(const Points& dense, const Feet& feet);
    double path_off() const;
    // Whether some pass stands off a rim or crease by more than its place on the surface asks for.
    bool moved_off_edges() const { return moved_off_edges_; }
    std::size_t pass_count() const { return passes_.size(); }

    // Links all passes; `spacing` (mm) is about the distance of neighbours.
    PlannedOperation finish(double spacing, double scallop_bound);

private:
    void check_tool() const;
    void check_form() const;
    void check_surfaces();
    Points path_of(const SurfacePass& pass) const;

    const Job& job_;
    const Operation& operation_;
    std::vector<Surface> surfaces_;
    std::unique_ptr<SurfaceModel> model_;
    std::unique_ptr<CertifiedPasses> certified_;
    std::vector<SurfacePass> passes_;
    bool moved_off_edges_{};
    int upright_{};  // surfaces
};

// Warns of places that may keep more than the scallop.
//
// bare    how many stay uncovered
// unseen  whether the look for them ended early
void report_bare_places(OperationStats& stats, std::size_t bare, bool unseen);

}  // namespace cusp::host
