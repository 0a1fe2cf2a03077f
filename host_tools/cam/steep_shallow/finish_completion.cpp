// Adds what checks of surfaces or triangles find missing.
#include "host_tools/cam/steep_shallow/finish_completion.hpp"

#include <algorithm>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/finishing/mesh_pencil_curves.hpp"
#include "host_tools/cam/finishing/proved_scallop.hpp"
#include "host_tools/cam/finishing/scallop_check.hpp"

#include "fmt/format.h"

namespace cusp::steep_shallow {

using finishing::CcParameterList;
using finishing::MeshCheck;
using finishing::Points;
using finishing::ProvedScallop;
using finishing::report_blocked;
using finishing::report_left_beside_edges;
using finishing::report_uncovered_points;
using finishing::report_walls_over_nothing;
using finishing::ScallopCheck;
using finishing::SurfaceOperation;
using job::Job;
using job::Operation;
using toolpath::PlannedOperation;

namespace {

constexpr double kCreasePitch = 0.45;  // of the stepover on level ground
// Shares of the progress.
constexpr double kChecked = 0.7;
constexpr double kCompleted = 0.95;

}  // namespace

void FinishCompletion::cut(const Points& tips, const CcParameterList& cc_parameters)
{
    cut_.push_back(work_.add_pass(tips, std::nullopt, cc_parameters));
}

void FinishCompletion::cut(SurfaceOperation::FittedPass pass)
{
    cut_.push_back(work_.add(std::move(pass)));
}

PlannedOperation FinishCompletion::finished(double step, double lead_in)
{
    if (operation_.passes.step_over) {
        prove(step);
    } else if (operation_.part.mesh.empty()) {
        complete_surfaces();
    } else {
        complete_mesh();
    }
    cut_.clear();
    job_.report_progress(kCompleted);
    PlannedOperation planned =
        work_.finish(step, left_.overflowed ? operation_.tool.radius : bound_, lead_in);
    report_uncovered_points(planned.stats, left_.uncovered, left_.overflowed);
    report_walls_over_nothing(planned.stats, left_.over_nothing);
    if (left_.measured) {
        report_blocked(planned.stats, left_, operation_.tool);
    }
    report_left_beside_edges(planned.stats, beside_edges_, bound_);
    return planned;
}

// The bound that planes `step` apart keep.
void FinishCompletion::prove(double step)
{
    if (operation_.part.mesh.empty()) {
        const ProvedScallop proved =
            finishing::proved_scallop(work_.surfaces(), work_.path_fitter(), work_.path_off(), cut_,
                                      {0, step, operation_.tool.radius, work_.outward()});
        bound_ = proved.bound;
        beside_edges_ = proved.beside_edges;
        left_.over_nothing = proved.over_nothing;
    } else {
        left_ = finishing::proved_mesh_scallop(operation_.part.mesh, work_.path_fitter(),
                                               work_.path_off(), cut_,
                                               {0, step, operation_.tool.radius, work_.outward()});
        bound_ = left_.most_left;
    }
}

// Adds the passes that the planes lack.
void FinishCompletion::complete_surfaces()
{
    ScallopCheck cells{work_.surfaces(), work_.path_fitter(), *operation_.tolerance.scallop,
                       work_.path_off()};
    const auto cut = [&](const Points& pass) {
        cells.add(work_.add_pass(pass));
    };
    for (const Points& pass : cut_) {
        cells.add(pass);
    }
    cells.check_all([&](double share) { report(kSectionsDone, kChecked, share); });
    cells.add_missing_passes(cut, [&](double share) { report(kChecked, kCompleted, share); });
    for (std::size_t k = 0; k < work_.surfaces().size(); ++k) {
        cells.add_rim_passes(static_cast<int>(k), cut);
    }
    left_ = {0,
             std::nullopt,
             cells.uncovered(),
             cells.overflowed(),
             cells.most_left(),
             cells.over_nothing()};
    bound_ = std::max(*operation_.tolerance.scallop, left_.most_left);
    beside_edges_ = cells.left_beside_edges();
}

void FinishCompletion::complete_mesh()
{
    const std::unique_ptr<MeshCheck> cells = finishing::mesh_check(
        operation_.part.mesh, work_.path_fitter(), *operation_.tolerance.scallop, work_.path_off());
    for (const Points& pass : cut_) {
        cells->add(pass);
    }
    // Along creases the proof is quick where a pass is: nothing lower is to be found.
    for (const Points& crease :
         finishing::mesh_pencil_curves(work_.path_fitter(), kCreasePitch * cells->step())) {
        for (const Points& pass : work_.creases_in_area(crease)) {
            cells->add(work_.add_pass(pass));
        }
    }
    cells->check();
    job_.report_progress(kChecked);
    cells->add_missing_passes([&](const Points& pass) { cells->add(work_.add_pass(pass)); });
    left_ = cells->left();
    bound_ = std::max(*operation_.tolerance.scallop, left_.most_left);
}

void FinishCompletion::report(double from, double to, double share) const
{
    job_.report_progress(from + (to - from) * share);
}

void check_sizes(const Job& job, const Operation& operation)
{
    const double radius = operation.tool.radius;
    if (!operation.passes.step_over && !operation.tolerance.scallop) {
        throw InputError(
            fmt::format("{}: {}: give step_over or scallop", job.file, operation.name()));
    }
    if (operation.passes.step_over && *operation.passes.step_over >= 2 * radius) {
        throw InputError(fmt::format(
            "{}: step_over is {:g} mm, passes of a tool of radius {:g} mm must be nearer than "
            "{:g} mm",
            job.file, *operation.passes.step_over, radius, 2 * radius));
    }
    if (operation.tolerance.scallop && *operation.tolerance.scallop >= radius) {
        throw InputError(
            fmt::format("{}: scallop is {:g} mm, not below the tool's radius of {:g} mm", job.file,
                        *operation.tolerance.scallop, radius));
    }
}

}  // namespace cusp::steep_shallow
