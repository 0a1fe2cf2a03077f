// From an operation to passes: curves of each surface, edges where surfaces meet, passes where the
// scallop is still too high, links.
#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "host_tools/base/cancellation/cancellation.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/adaptive_isocurve/curve_passes.hpp"
#include "host_tools/cam/adaptive_isocurve/isocurve_floor.hpp"
#include "host_tools/cam/adaptive_isocurve/isocurve_selection.hpp"
#include "host_tools/cam/adaptive_isocurve/mesh_isocurves.hpp"
#include "host_tools/cam/adaptive_isocurve/offset_curve_trimmer.hpp"
#include "host_tools/cam/adaptive_isocurve/share_of_count.hpp"
#include "host_tools/cam/adaptive_isocurve/waterline_roughing.hpp"
#include "host_tools/cam/finishing/proved_scallop.hpp"
#include "host_tools/cam/finishing/scallop_check.hpp"
#include "host_tools/cam/finishing/surface_operation.hpp"
#include "host_tools/geometry/part_model/offset_surface.hpp"
#include "host_tools/geometry/toolpath/stepover.hpp"

#include "fmt/format.h"

namespace cusp::adaptive_isocurve {

using finishing::CcParameterList;
using finishing::length_of;
using finishing::Points;
using finishing::proved_scallop;
using finishing::ProvedScallop;
using finishing::report_left_beside_edges;
using finishing::report_uncovered_points;
using finishing::report_walls_over_nothing;
using finishing::ScallopCheck;
using finishing::SurfaceOperation;
using finishing::SweptVolume;
using finishing::ToleranceBand;
using job::CutDirection;
using job::Job;
using job::kRoughingDone;
using job::Operation;
using job::OutputForm;
using job::Traversal;
using nurbs::Curve;
using nurbs::Surface;
using nurbs::SurfacePoint;
using part_model::OffsetRequest;
using part_model::OffsetSurface;
using toolpath::PlannedOperation;
using toolpath::stepover;

namespace {

// Share of the domain: where the scallop is too high on more, curves are chosen again with scallops
// computed along the curved passes, which takes twice as long.
constexpr double kOpenShare = 0.01;
constexpr double kOffsetShare = 0.9;       // of the band: for the error of an approximated offset
constexpr int kNormalSamples = 8;          // along u and v
constexpr std::size_t kCurvesAtOnce = 32;  // while the next ones may be clear as a whole
constexpr std::size_t kManyCurvesAtOnce = 512;
constexpr double kEdgeGrid = 0.7;  // in steps
constexpr double kSameEdge = 0.1;  // in steps: edges nearer than this are one

std::string place_of_faces(const Operation& operation)
{
    return operation.part.floor_files.size() == 1 ? " of " + operation.part.floor_files.front()
                                                  : " of the floor";
}

// Shares of the progress.
constexpr double kPassesDone = 0.4;
constexpr double kCheckDone = 0.5;
constexpr double kMissingDone = 0.95;

class IsocurvePlanner {
public:
    IsocurvePlanner(const Job& job, const Operation& operation, const LevelFloors& floors)
        : job_{job},
          operation_{operation},
          work_{job, operation, surfaces_along_u(operation)},
          tracer_{work_.surfaces(), work_.path_fitter()},
          plain_{work_.surfaces().size() == 1 && is_plain(work_.surfaces().front())},
          selection_{operation, work_, plain_}
    {
        leave_out(floors, work_);
        if (operation.tolerance.scallop && !finish_keys(operation).iso_distance) {
            scallop_check_.emplace(work_.surfaces(), work_.path_fitter(),
                                   *operation.tolerance.scallop, work_.path_off());
        }
    }

    PlannedOperation plan(bool complete)
    {
        std::size_t curves = 0;
        for (std::size_t k = 0; k < work_.surfaces().size(); ++k) {
            curves += add_surface(static_cast<int>(k), complete);
        }
        whole_ = whole_ && !work_.moved_off_edges();
        std::size_t uncovered = 0;
        bool unseen = false;
        if (scallop_check_ && !(plain_ && whole_ && open_.empty())) {
            check_scallops();
            scallop_check_->add_missing_passes(
                [&](const Points& pass) { add_pass(pass); },
                [&](double share) { report(kCheckDone + (kMissingDone - kCheckDone) * share); });
            uncovered = scallop_check_->uncovered();
            scallop_ = std::max(*operation_.tolerance.scallop, scallop_check_->most_left());
            unseen = scallop_check_->overflowed();
            over_nothing_ = scallop_check_->over_nothing();
            scallop_ = unseen ? operation_.tool.radius : scallop_;
        }
        if (!scallop_check_) {
            const ProvedScallop proved =
                proved_scallop(work_.surfaces(), work_.path_fitter(), work_.path_off(), cut_,
                               {scallop_, spacing_, operation_.tool.radius, work_.outward()});
            take(proved);
        }
        const bool checked = scallop_check_.has_value();
        if (checked) {
            end_scallop_check();
        }
        report(kMissingDone);
        PlannedOperation planned = work_.finish(spacing_, scallop_);
        report_uncovered_points(planned.stats, uncovered, unseen);
        report_walls_over_nothing(planned.stats, over_nothing_);
        planned.stats.counts.emplace_back("isocurves", static_cast<double>(curves));
        if (checked) {
            planned.stats.counts.emplace_back("cells_share", cells_share_);
        }
        report_left_beside_edges(planned.stats, beside_edges_, scallop_);
        const double apart = selection_.spacing_bound();
        if (apart > 0) {
            planned.stats.counts.emplace_back("iso_distance_bound_mm", apart);
        }
        if (apart > finish_keys(operation_).iso_distance.value_or(apart)) {
            planned.stats.warnings.push_back(
                "neighbouring passes are not proved to be within iso_distance everywhere");
        }
        if (operation_.output == OutputForm::kNurbs) {
            planned.stats.counts.emplace_back("offset_isocurves", exact_curves_);
            planned.stats.counts.emplace_back("offset_bound_mm", offset_error_);
            planned.stats.counts.emplace_back("offset_control_points", offset_points_);
        }
        if (unreached_ > 0) {
            planned.stats.warnings.push_back(fmt::format(
                "{} of {} curves end where the tool would cut another place of the model (concave "
                "edges, undercuts, valleys narrower than the ball): stock is left there",
                unreached_, curves));
        }
        return planned;
    }

private:
    void take(const ProvedScallop& proved)
    {
        scallop_ = proved.bound;
        beside_edges_ = proved.beside_edges;
        over_nothing_ = proved.over_nothing;
    }

    void report(double share) const
    {
        job_.report_progress(share, operation_.passes.roughing ? kRoughingDone : 0);
    }

    void add_pass(const Points& dense,
                  const std::optional<Curve>& exact = std::nullopt,
                  const CcParameterList& cc_parameters = {})
    {
        remember(work_.add_pass(dense, exact, cc_parameters));
    }

    void remember(const Points& points)
    {
        if (scallop_check_) {
            scallop_check_->add(points);
        } else {
            cut_.push_back(points);
        }
    }

    void end_scallop_check()
    {
        for (std::size_t k = 0; k < work_.surfaces().size(); ++k) {
            scallop_check_->add_rim_passes(static_cast<int>(k),
                                           [&](const Points& pass) { add_pass(pass); });
        }
        beside_edges_ = std::max(beside_edges_, scallop_check_->left_beside_edges());
        // Its cutters and proofs are most of the memory, and links need as much.
        scallop_check_.reset();
    }

    // Examines all surfaces, or of one smooth surface only the strips with too high a scallop.
    void check_scallops()
    {
        const std::vector<Surface>& surfaces = work_.surfaces();
        cells_share_ = share_of_domain(open_, surfaces.front());
        if (plain_ && whole_ && cells_share_ < 1) {
            for (const IsocurveScallop::Strip& strip : open_) {
                scallop_check_->check(0, {strip.u0, strip.v0}, {strip.u1, strip.v1});
            }
            return;
        }
        cells_share_ = 1;
        scallop_check_->check_all(
            [&](double share) { report(kPassesDone + (kCheckDone - kPassesDone) * share); });
    }

    // share  of the surface's curves that are fitted
    void report_curves(int surface, double share) const
    {
        const double done = plain_ ? kMissingDone : kPassesDone;
        report(done * (surface + share) / static_cast<double>(work_.surfaces().size()));
    }

    std::size_t add_surface(int surface, bool complete)
    {
        const cancellation::Part part = part_of(surface);
        const Surface& s = work_.surfaces()[static_cast<std::size_t>(surface)];
        std::vector<DomainCurve> curves = selection_.curves_of(surface, complete, false);
        IsocurveScallop::Highest highest = selection_.highest_between(surface, curves);
        if (plain_ && share_of_domain(highest.open, s) > kOpenShare) {
            curves = selection_.curves_of(surface, complete, true);
            highest = selection_.highest_between(surface, curves);
        }
        if (operation_.passes.traversal == Traversal::kOneWay) {
            put_in_cutting_order(surface, curves);
        }
        spacing_ = finish_keys(operation_).iso_distance
                       ? *finish_keys(operation_).iso_distance
                       : stepover(operation_.tool.radius, *operation_.tolerance.scallop, 0);
        add_edges(add_curves(surface, curves));
        scallop_ = std::max(scallop_, highest.scallop_height);
        open_ = highest.open;
        return curves.size();
    }

    // Adds the passes along the curves. Returns the edges of the part that the tool can finish; none
    // where that is the whole surface.
    std::vector<Points> add_curves(int surface, const std::vector<DomainCurve>& curves)
    {
        const Surface& s = work_.surfaces()[static_cast<std::size_t>(surface)];
        const std::optional<OffsetSurface> offset = offset_of(s);
        const CurveFitter fitter{work_, tracer_};
        bool trimmed = false;
        std::optional<std::vector<Points>> edges;
        const auto find_edges = [&] {
            edges = tracer_.clear_region_edges(surface, kEdgeGrid * spacing_);
        };
        bool may_be_clear = s.trims.empty() && operation_.output == OutputForm::kLines;
        ShareOfCount done{curves.size(), [&](double share) {
                              report_curves(surface, share);
                          }};
        for (std::size_t begin = 0, end = 0; begin < curves.size(); begin = end) {
            end = begin + (may_be_clear ? kCurvesAtOnce : kManyCurvesAtOnce);
            end = std::min(curves.size(), end);
            const part_model::PartModel::SharedQueries shared{work_.model()};
            std::vector<CurvePasses> fitted;
            const auto fit = [&] {
                fitted =
                    fitter.fitted(curves, begin, end, may_be_clear, offset, [&] { done.count(); });
            };
            // One curve may be half of a face's work: edges are found meanwhile.
            if (trimmed && !edges) {
                parallel::both(fit, find_edges);
            } else {
                fit();
            }
            work_.model().forget_queries();
            for (CurvePasses& passes : fitted) {
                trimmed = trimmed || !passes.whole;
                may_be_clear = may_be_clear && passes.whole;
                unreached_ += passes.blocked ? 1 : 0;
                exact_curves_ += passes.exact;
                for (SurfaceOperation::FittedPass& pass : passes.passes) {
                    remember(work_.add(std::move(pass)));
                }
            }
        }
        whole_ = whole_ && !trimmed;
        if (trimmed && !edges) {
            find_edges();
        }
        return edges ? std::move(*edges) : std::vector<Points>{};
    }

    // For exact curves.
    std::optional<OffsetSurface> offset_of(const Surface& surface)
    {
        if (operation_.output != OutputForm::kNurbs) {
            return std::nullopt;
        }
        const ToleranceBand& band = work_.path_fitter().band();
        std::optional<OffsetSurface> out;
        out.emplace(surface, OffsetRequest{operation_.tool.radius + band.offset,
                                           kOffsetShare * band.half_width});
        offset_error_ = std::max(offset_error_, out->error_bound());
        offset_points_ += out->control_points();
        return out;
    }

    cancellation::Part part_of(int surface) const
    {
        return {"face ", surface + 1, place_of_faces(operation_)};
    }

    // Climb milling: the uncut stock lies to the right of the path, since the tool turns clockwise.
    void put_in_cutting_order(int surface, std::vector<DomainCurve>& curves) const
    {
        const Surface& s = work_.surfaces()[static_cast<std::size_t>(surface)];
        double up = 0;
        for (int i = 1; i < kNormalSamples; ++i) {
            for (int j = 1; j < kNormalSamples; ++j) {
                const SurfacePoint p = work_.model().evaluate(
                    surface, s.u_begin() + (s.u_end() - s.u_begin()) * i / kNormalSamples,
                    s.v_begin() + (s.v_end() - s.v_begin()) * j / kNormalSamples);
                up += cross(p.du, p.dv).z;
            }
        }
        const auto middle = [](const DomainCurve& curve) {
            return std::accumulate(curve.v.begin(), curve.v.end(), 0.0) /
                   static_cast<double>(curve.v.size());
        };
        const bool climb = operation_.passes.direction_of_cut == CutDirection::kClimb;
        const double sign = (up > 0) == climb ? -1 : 1;
        std::stable_sort(curves.begin(), curves.end(),
                         [&](const DomainCurve& a, const DomainCurve& b) {
                             return sign * middle(a) < sign * middle(b);
                         });
    }

    // An edge where the tool touches two surfaces is found for both and cut once.
    void add_edges(const std::vector<Points>& found)
    {
        const double near = kSameEdge * spacing_;
        if (!edges_) {
            edges_.emplace(near, std::max(near, 0.25 * operation_.tool.radius));
        }
        for (const Points& edge : found) {
            Points run;
            for (const Vec3d& tip : edge) {
                if (!cut_already(tip)) {
                    run.push_back(tip);
                    continue;
                }
                // One point more, so that the runs meet.
                run.push_back(tip);
                add_run(run);
            }
            add_run(run);
        }
        for (const Points& edge : found) {
            edges_->add(edge);
        }
    }

    void add_run(Points& run)
    {
        if (run.size() > 1 && length_of(run) > kSameEdge * spacing_) {
            for (const auto& [first, last] : work_.ranges_in_area(run, {})) {
                add_pass({run.begin() + static_cast<std::ptrdiff_t>(first),
                          run.begin() + static_cast<std::ptrdiff_t>(last + 1)});
            }
        }
        run.clear();
    }

    bool cut_already(Vec3d tip) const
    {
        const Vec3d centre = tip + Vec3d{0, 0, kSameEdge * spacing_};
        std::vector<std::uint32_t> moves;
        edges_->near(centre, moves);
        return std::any_of(moves.begin(), moves.end(),
                           [&](std::uint32_t move) { return edges_->passes_near(move, centre); });
    }

    const Job& job_;
    const Operation& operation_;
    SurfaceOperation work_;
    OffsetCurveTrimmer tracer_;
    // One smooth surface: where all its passes are whole, it has no other scallops than those
    // between neighbours.
    bool plain_;
    IsocurveSelection selection_;
    std::optional<ScallopCheck> scallop_check_;
    std::vector<Points> cut_;           // the passes, where there is no scallop check
    std::optional<SweptVolume> edges_;  // of the parts that the tool can finish, as thin balls
    bool whole_{true};                  // all passes run from end to end
    double spacing_{};
    double scallop_{};
    std::vector<IsocurveScallop::Strip> open_;  // of one smooth surface: the scallop is too high
    double cells_share_{};   // of the surfaces' domains: examined by the scallop check
    double beside_edges_{};  // mm: left there
    double over_nothing_{};  // mm
    int unreached_{};
    int exact_curves_{};
    double offset_error_{};
    int offset_points_{};
};

std::vector<PlannedOperation> plan(const Job& job, const Operation& operation, bool complete)
{
    check_spacing(job, operation);
    std::vector<PlannedOperation> out;
    const Operation finished = complete ? operation : finishing::faceted(operation);
    const bool mesh = !complete && !finished.part.mesh.empty();
    const LevelFloors floors = level_floors(job, finished);
    std::optional<IsocurvePlanner> planner;
    if (!mesh) {
        const cancellation::Part part{"the model of ",
                                      static_cast<int>(operation.part.floor.size()),
                                      " faces" + place_of_faces(operation)};
        planner.emplace(job, operation, floors);
    }
    PlannedOperation finish;
    const auto rough = [&] {
        if (operation.passes.roughing) {
            std::optional<cancellation::Part> part;
            if (!mesh) {
                part.emplace("the roughing of ", static_cast<int>(operation.part.floor.size()),
                             " faces" + place_of_faces(operation));
            }
            out = plan_waterline_roughing(job, operation, floors);
        }
    };
    parallel::both(rough, [&] {
        const auto begin = std::chrono::steady_clock::now();
        finish = mesh ? plan_mesh_isocurves(job, finished, floors) : planner->plan(complete);
        finish.stats.planning_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    });
    std::vector<std::string> why_not_roughed;
    if (!out.empty() && out.front().path.moves.empty()) {
        why_not_roughed = std::move(out.front().stats.warnings);
        out.clear();
    }
    if (finish.path.moves.empty() && !floors.levels().empty()) {
        for (PlannedOperation& rough : out) {  // it has cut all that is to be finished
            rough.stats.scallop_bound_mm = finish.stats.scallop_bound_mm;
        }
    }
    out.push_back(std::move(finish));
    std::vector<std::string>& warnings = out.back().stats.warnings;
    warnings.insert(warnings.end(), why_not_roughed.begin(), why_not_roughed.end());
    return out;
}

}  // namespace

std::vector<PlannedOperation> plan_adaptive_isocurve(const Job& job, const Operation& operation)
{
    return plan(job, operation, false);
}

std::vector<PlannedOperation> plan_complete_isocurves(const Job& job, const Operation& operation)
{
    return plan(job, operation, true);
}

}  // namespace cusp::adaptive_isocurve
