// The pass of a plane is the tool dropped along a line. If the planes leave too much there are
// passes between them.
#include "host_tools/cam/adaptive_isocurve/parallel_planes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/adaptive_isocurve/proved_scallop.hpp"
#include "host_tools/cam/adaptive_isocurve/surface_operation.hpp"
#include "host_tools/cam/finishing/contact_tracker.hpp"
#include "host_tools/cam/finishing/mesh_scallop_check.hpp"
#include "host_tools/cam/finishing/scallop_check.hpp"
#include "host_tools/geometry/toolpath/stepover.hpp"

#include "fmt/format.h"

namespace cusp::adaptive_isocurve {

using finishing::CcParameterList;
using finishing::ContactTracker;
using finishing::MeshScallopCheck;
using finishing::Points;
using finishing::ScallopCheck;
using job::Job;
using job::Operation;
using nurbs::Surface;
using nurbs::SurfacePoint;
using toolpath::PlannedOperation;
using toolpath::stepover;

namespace {

constexpr int kSlopeSamples = 150;
constexpr double kPlaneSamples = 1 / 3.0;  // of the reach of the tool
constexpr int kPlaneEndHalvings = 20;
constexpr double kShortestPlaneRun = 1e-3;  // mm
// Share of the stepover on level ground: points that require less (75 degrees steep, or nearly as
// hollow as the ball) do not count; they get passes of their own.
constexpr double kLeastPlaneShare = 0.25;
constexpr double kMeshShare = 0.9;           // of the stepover on a flat facet: meshes bend
constexpr double kPlaneScallopShare = 0.99;  // the rest is for bends along the path
constexpr double kMostPlanes = 20000;
// Shares of the progress.
constexpr double kPlanesDone = 0.5;
constexpr double kPlanesChecked = 0.7;
constexpr double kPlanesCompleted = 0.95;

// The projection of a unit vector across the planes onto the tangent plane: its length is the
// cosine of the slope.
Vec3d along_slope(Vec3d across, Vec3d normal) { return across - normal * dot(across, normal); }

// Spacing of planes for the scallop at one point: that of the ball's centres, in plan across the
// planes. None where the surface has no normal.
//
// across  a horizontal unit vector
std::optional<double> plane_step(const SurfacePoint& p,
                                 Vec3d across,
                                 double radius,
                                 double scallop_height)
{
    const Vec3d normal = upward_normal(p);
    const double e = dot(p.du, p.du);
    const double f = dot(p.du, p.dv);
    const double g = dot(p.dv, p.dv);
    const double det = e * g - f * f;
    if (dot(normal, normal) == 0 || at_pole(p.du, p) || at_pole(p.dv, p) || !(det > 0)) {
        return std::nullopt;
    }
    const Vec3d step = along_slope(across, normal);
    const double square = dot(step, step);
    if (square < kLeastPlaneShare * kLeastPlaneShare) {
        return 0.0;
    }
    // The step by du and dv, for its normal curvature.
    const double a = (dot(step, p.du) * g - dot(step, p.dv) * f) / det;
    const double b = (dot(step, p.dv) * e - dot(step, p.du) * f) / det;
    const double curvature =
        -dot(normal, p.duu * (a * a) + p.duv * (2 * a * b) + p.dvv * (b * b)) / square;
    // Contacts are a stepover apart; centres are closer in hollows and farther over hills.
    const double apart = stepover(radius, scallop_height, curvature) * (1 + radius * curvature);
    return std::clamp(apart, 0.0, 2 * radius) * std::sqrt(square);
}

class PlanePlanner {
public:
    PlanePlanner(const Job& job, const Operation& operation)
        : job_{job},
          operation_{operation},
          work_{job, operation, operation.part.floor},
          ball_{work_.path_fitter()}
    {
        across_ = isocurve_keys(operation).direction == 'u' ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
        along_ = {across_.y, across_.x, 0};
        low_ = work_.model().box_low();
        size_ = work_.model().box_high() - low_;
        reach_ = work_.path_fitter().offset_tool().radius;
    }

    PlannedOperation plan()
    {
        const double step =
            operation_.passes.step_over ? *operation_.passes.step_over : step_for_scallop();
        const double width = dot(size_, across_);
        if (width + 2 * reach_ > kMostPlanes * step) {
            throw InputError(fmt::format(
                "{}: parallel_planes: planes {:.3g} mm apart ({}) over a part of {:g} mm and what "
                "the tool reaches beyond it would be {:.0f}, at most {:g} are made",
                job_.file, step, operation_.passes.step_over ? "step_over" : "by the scallop",
                width, std::ceil((width + 2 * reach_) / step), kMostPlanes));
        }
        const int planes = std::max(1, static_cast<int>(std::ceil(width / step)));
        // A ball on a slope that ends in a rim is beyond the rim.
        const double lean = std::min(step, 0.5 * reach_) / reach_;
        least_facing_ = std::sqrt(1 - lean * lean);
        const int beyond = static_cast<int>(std::ceil(reach_ / step));
        for (int k = -beyond; k <= planes + beyond; ++k) {
            const int before = std::min(k, 0);
            const int after = std::max(k - planes, 0);
            add_plane(width * (k - before - after) / planes + step * (before + after));
            job_.report_progress(kPlanesDone * (k + beyond + 1) / (planes + 2 * beyond + 1));
        }
        return finished(step);
    }

private:
    PlannedOperation finished(double step)
    {
        if (operation_.passes.step_over) {
            prove(step);
        } else if (operation_.part.mesh.empty()) {
            complete_surfaces();
        } else {
            complete_mesh();
        }
        cut_.clear();
        job_.report_progress(kPlanesCompleted);
        PlannedOperation planned = work_.finish(step, unseen_ ? operation_.tool.radius : bound_);
        report_uncovered_points(planned.stats, uncovered_, unseen_);
        report_walls_over_nothing(planned.stats, over_nothing_);
        report_left_beside_edges(planned.stats, beside_edges_, bound_);
        return planned;
    }

    // The bound that planes `step` apart keep.
    void prove(double step)
    {
        if (operation_.part.mesh.empty()) {
            const ProvedScallop proved =
                proved_scallop(work_.surfaces(), work_.path_fitter(), work_.path_off(), cut_,
                               {0, step, operation_.tool.radius, work_.outward()});
            bound_ = proved.bound;
            beside_edges_ = proved.beside_edges;
            over_nothing_ = proved.over_nothing;
        } else {
            bound_ =
                proved_mesh_scallop(operation_.part.mesh, work_.path_fitter(), work_.path_off(),
                                    cut_, {0, step, operation_.tool.radius, work_.outward()});
        }
    }

    // Adds the passes that the planes lack.
    void complete_surfaces()
    {
        ScallopCheck cells{work_.surfaces(), work_.path_fitter(), *operation_.tolerance.scallop,
                           work_.path_off()};
        const auto cut = [&](const Points& pass) {
            cells.add(work_.add_pass(pass));
        };
        for (const Points& pass : cut_) {
            cells.add(pass);
        }
        cells.check_all([&](double share) { report(kPlanesDone, kPlanesChecked, share); });
        cells.add_missing_passes(
            cut, [&](double share) { report(kPlanesChecked, kPlanesCompleted, share); });
        for (std::size_t k = 0; k < work_.surfaces().size(); ++k) {
            cells.add_rim_passes(static_cast<int>(k), cut);
        }
        take(cells);
        beside_edges_ = cells.left_beside_edges();
    }

    void complete_mesh()
    {
        MeshScallopCheck cells{operation_.part.mesh, work_.path_fitter(),
                               *operation_.tolerance.scallop, work_.path_off()};
        for (const Points& pass : cut_) {
            cells.add(pass);
        }
        cells.check();
        job_.report_progress(kPlanesChecked);
        cells.add_missing_passes([&](const Points& pass) { cells.add(work_.add_pass(pass)); });
        take(cells);
    }

    template <typename Check>
    void take(const Check& cells)
    {
        bound_ = std::max(*operation_.tolerance.scallop, cells.most_left());
        uncovered_ = cells.uncovered();
        unseen_ = cells.overflowed();
        over_nothing_ = cells.over_nothing();
    }

    void report(double from, double to, double share) const
    {
        job_.report_progress(from + (to - from) * share);
    }

    double step_for_scallop()
    {
        const double scallop_height =
            kPlaneScallopShare * (*operation_.tolerance.scallop - work_.outward());
        const double on_level = stepover(operation_.tool.radius, scallop_height, 0);
        double least = on_level;
        const auto ask = [&](double step) {
            least = step < kLeastPlaneShare * on_level ? least : std::min(least, step);
        };
        for (const auto& facet : operation_.part.mesh) {
            const Vec3d n = cross(facet[1] - facet[0], facet[2] - facet[0]);
            ask(kMeshShare * on_level * norm(along_slope(across_, n / norm(n))));
        }
        for (std::size_t k = 0; k < work_.surfaces().size(); ++k) {
            const Surface& s = work_.surfaces()[k];
            for (int i = 0; i <= kSlopeSamples; ++i) {
                for (int j = 0; j <= kSlopeSamples; ++j) {
                    const double u = s.u_begin() + (s.u_end() - s.u_begin()) * i / kSlopeSamples;
                    const double v = s.v_begin() + (s.v_end() - s.v_begin()) * j / kSlopeSamples;
                    const int surface = static_cast<int>(k);
                    if (const auto step = plane_step(work_.model().evaluate(surface, u, v), across_,
                                                     operation_.tool.radius, scallop_height);
                        step && work_.model().inside_trims(surface, u, v)) {
                        ask(*step);
                    }
                }
            }
        }
        return least;
    }

    Vec3d place(double s, double t) const { return low_ + along_ * s + across_ * t; }

    // True if the tool dropped there touches the model. Beyond the model's box it may overhang the
    // rim by a step, since the last pass is less than a step from the rim.
    bool is_clear(double s, double t)
    {
        const Vec3d at = place(s, t);
        const std::optional<ContactTracker::BallPosition> found = ball_.at(at.x, at.y);
        const bool over_box =
            s >= 0 && s <= dot(size_, along_) && t >= 0 && t <= dot(size_, across_);
        return found && (over_box || found->facing >= least_facing_);
    }

    // Adds the parts of the plane at t where the tool is on the model.
    void add_plane(double t)
    {
        const double from = -reach_;
        const double to = dot(size_, along_) + reach_;
        const int parts = static_cast<int>(std::ceil((to - from) / (kPlaneSamples * reach_)));
        double begin = from;
        double last = from;
        bool was_on = is_clear(from, t);
        for (int k = 1; k <= parts; ++k) {
            const double s = from + (to - from) * k / parts;
            const bool on = is_clear(s, t);
            if (on && !was_on) {
                begin = run_end(last, s, t);
            } else if (!on && was_on) {
                add_run(begin, run_end(s, last, t), t);
            }
            was_on = on;
            last = s;
        }
        if (was_on) {
            add_run(begin, to, t);
        }
    }

    double run_end(double outside, double inside, double t)
    {
        for (int turn = 0; turn < kPlaneEndHalvings; ++turn) {
            const double middle = 0.5 * (outside + inside);
            (is_clear(middle, t) ? inside : outside) = middle;
        }
        return inside;
    }

    void add_run(double from, double to, double t)
    {
        if (to - from > kShortestPlaneRun) {
            CcParameterList cc_parameters;
            const Points dense =
                work_.path_fitter().sample_dropped(place(from, t), place(to, t), &cc_parameters);
            cut_.push_back(work_.add_pass(dense, std::nullopt, cc_parameters));
        }
    }

    const Job& job_;
    const Operation& operation_;
    SurfaceOperation work_;
    ContactTracker ball_;
    Vec3d across_;
    Vec3d along_;
    Vec3d low_;
    Vec3d size_;
    double reach_{};  // mm: how far beyond the box the tool can touch the model
    double least_facing_{};
    std::vector<Points> cut_;
    double bound_{};         // mm: of the scallop
    double beside_edges_{};  // mm
    double over_nothing_{};  // mm
    std::size_t uncovered_{};
    bool unseen_{};
};

void check_planes(const Job& job, const Operation& operation)
{
    const double radius = operation.tool.radius;
    if (!operation.passes.step_over && !operation.tolerance.scallop) {
        throw InputError(
            fmt::format("{}: {}: give step_over or scallop", job.file, operation.name()));
    }
    if (operation.passes.step_over && *operation.passes.step_over >= 2 * radius) {
        throw InputError(fmt::format(
            "{}: step_over is {:g} mm, planes of a ball of radius {:g} mm must be nearer than "
            "{:g} mm",
            job.file, *operation.passes.step_over, radius, 2 * radius));
    }
    if (operation.tolerance.scallop && *operation.tolerance.scallop >= radius) {
        throw InputError(
            fmt::format("{}: scallop is {:g} mm, not below the tool's radius of {:g} mm", job.file,
                        *operation.tolerance.scallop, radius));
    }
}

}  // namespace

std::vector<PlannedOperation> plan_parallel_planes(const Job& job, const Operation& operation)
{
    const auto begin = std::chrono::steady_clock::now();
    check_planes(job, operation);
    PlannedOperation planned = PlanePlanner{job, operation}.plan();
    planned.stats.planning_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return {std::move(planned)};
}

}  // namespace cusp::adaptive_isocurve
