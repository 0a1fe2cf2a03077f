// Checks of the input first; then passes in the requested form, links and statistics.
#include "host_tools/cam/finishing/surface_operation.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/finishing/contact_tracker.hpp"
#include "host_tools/geometry/part_model/certified_facets.hpp"
#include "host_tools/geometry/toolpath/stepover.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

#include "fmt/format.h"

namespace cusp::finishing {

using job::Job;
using job::Operation;
using job::OutputForm;
using job::ToleranceSide;
using job::Traversal;
using nurbs::Curve;
using nurbs::Surface;
using nurbs::SurfacePoint;
using part_model::PartModel;
using toolpath::MoveKind;
using toolpath::NurbsTo;
using toolpath::OperationStats;
using toolpath::PlannedOperation;
using toolpath::Tool;
using toolpath::ToolMove;
using toolpath::ToolShape;

namespace {

constexpr double kSameTip = 1e-6;      // mm: rounding of a tip on the stock's top
constexpr double kSameTop = 1e-3;      // mm between the tops of stock and part
constexpr double kOverStock = 1.0;     // mm above the stock at which rapids end
constexpr double kLeastSize = 1e-6;    // mm
constexpr double kLeastFacing = 1e-6;  // z of a normal
constexpr double kChordOfBand = 0.2;   // of the band: between arcs or curves and their chords
constexpr double kFacetShare = 0.1;    // of the tolerance: less than what passes keep of it
constexpr double kShownArea = 1e-2;    // mm2
constexpr double kAreaMargin = 0.25;   // of the stepover on level ground

std::string file_of(const Operation& operation)
{
    return operation.part.floor_files.empty() ? std::string{"floor"}
                                              : operation.part.floor_files.front();
}

// mm: the cells of a proof are so large, and may lie half in the area.
double margin_of(const Operation& operation)
{
    const double corner = operation.tool.corner_radius;
    return operation.tolerance.scallop && corner > 0
               ? kAreaMargin * toolpath::stepover(corner, *operation.tolerance.scallop, 0)
               : operation.tolerance.floor;
}

}  // namespace

void check_clearance(const Job& job, const Operation& operation, const PartModel& model)
{
    const double clearance = job.stock_top + job.clearance;
    if (model.box_high().z <= clearance) {
        return;
    }
    if (const double top = model.highest(); top > clearance) {
        throw InputError(
            fmt::format("{}: the part rises to z = {:.6g} mm, over the clearance height of {:g} mm "
                        "(stock top {:g} + clearance {:g}): rapid moves would hit it",
                        file_of(operation), top, clearance, job.stock_top, job.clearance));
    }
}

Operation faceted(const Operation& operation)
{
    Operation out = operation;
    if (operation.tool.shape == ToolShape::kBall || operation.part.floor.empty()) {
        return out;
    }
    const double scallop = operation.tolerance.scallop.value_or(operation.tolerance.floor);
    const double error = kFacetShare * std::min(operation.tolerance.floor, scallop);
    out.part.mesh = part_model::certified_facets(operation.part.floor, error);
    out.part.floor.clear();
    out.part.facet_error = error;
    out.tolerance.floor -= error;
    if (out.tolerance.scallop) {
        *out.tolerance.scallop -= error;
    }
    return out;
}

SurfaceOperation::SurfaceOperation(const Job& job,
                                   const Operation& operation,
                                   std::vector<Surface> surfaces)
    : job_{job}, operation_{operation}, surfaces_{std::move(surfaces)}
{
    check_tool();
    check_form();
    check_surfaces();
    model_ = surfaces_.empty() ? std::make_unique<PartModel>(operation.part.mesh)
                               : std::make_unique<PartModel>(surfaces_);
    check_clearance(job, operation, *model_);
    ToleranceBand band = make_tolerance_band(
        operation.tolerance.floor,
        surfaces_.empty() || operation.tolerance.side == ToleranceSide::kOutside);
    band.max_gouge -= operation.part.facet_error;
    path_fitter_ = std::make_unique<GougeFreePathFitter>(*model_, operation.tool, band);
    path_fitter_->check_edge_gouges(surfaces_);
    path_fitter_->limit_to(std::make_shared<FinishArea>(operation, margin_of(operation)));
}

// Keys without effect are errors, never ignored.
void SurfaceOperation::check_form() const
{
    if (operation_.passes.roughing && operation_.strategy->traits.only_finishes) {
        throw InputError(
            fmt::format("{}: {} only finishes: roughing = true is for adaptive_isocurve", job_.file,
                        operation_.name()));
    }
    if (!operation_.passes.roughing && operation_.passes.allowance > 0) {
        throw InputError(
            fmt::format("{}: {}: allowance is {:g} mm, but nothing is roughed: "
                        "add roughing = true, or remove allowance",
                        job_.file, operation_.name(), operation_.passes.allowance));
    }
    const bool other_tools =
        std::any_of(operation_.tools.begin(), operation_.tools.end(),
                    [&](const Tool& tool) { return tool.number != operation_.tool.number; });
    if (!operation_.passes.roughing && other_tools) {
        throw InputError(
            fmt::format("{}: {}: tools names the tools that rough: add roughing = "
                        "true; `tool` is the one that finishes",
                        job_.file, operation_.name()));
    }
    if (!operation_.passes.roughing &&
        (operation_.levels.max_depth || operation_.levels.min_depth ||
         !operation_.levels.layers.empty())) {
        throw InputError(
            fmt::format("{}: {}: max_depth, min_depth and layers are for roughing = true",
                        job_.file, operation_.name()));
    }
}

void SurfaceOperation::check_tool() const
{
    const Tool& tool = operation_.tool;
    if (tool.shape != ToolShape::kBall && !surfaces_.empty()) {
        throw InputError(fmt::format(
            "{}: {} finishes with a ball; tool {} has shape = \"{}\"; parallel_planes, waterline, "
            "steep_shallow and adaptive_isocurve take any end",
            job_.file, operation_.name(), tool.number, name_of(tool.shape)));
    }
    if (!(operation_.tolerance.floor < tool.radius)) {
        throw InputError(fmt::format("{}: floor_tolerance is {:g} mm, the tool's radius {:g} mm",
                                     job_.file, operation_.tolerance.floor, tool.radius));
    }
}

std::vector<SurfaceOperation::Range> SurfaceOperation::ranges_where(
    std::size_t count, const std::function<bool(std::size_t)>& holds) const
{
    if (area().is_everything()) {
        return {{0, count - 1}};
    }
    std::vector<Range> out;
    for (std::size_t k = 0; k < count; ++k) {
        if (!holds(k)) {
            continue;
        }
        if (!out.empty() && out.back().second + 1 == k) {
            out.back().second = k;
        } else {
            out.emplace_back(k, k);
        }
    }
    return out;
}

std::vector<SurfaceOperation::Range> SurfaceOperation::ranges_in_area(
    const Points& tips, const CcParameterList& cc_parameters) const
{
    ContactTracker tool{*path_fitter_};
    return ranges_where(tips.size(), [&](std::size_t k) {
        if (k < cc_parameters.size() && cc_parameters[k].surface >= 0) {
            const CcParameters& cc = cc_parameters[k];
            const auto at = model_->cc_point(cc.surface, cc.u, cc.v, 0);
            return area().holds(at.point, at.normal);
        }
        const auto found = tool.at(tips[k].x, tips[k].y);
        return found && area().holds(found->point, found->lean);
    });
}

std::vector<Points> SurfaceOperation::creases_in_area(const Points& crease) const
{
    constexpr double kBeside = 0.02;  // radii
    const double away = kBeside * operation_.tool.radius;
    ContactTracker tool{*path_fitter_};
    const auto holds = [&](double x, double y) {
        const auto found = tool.at(x, y);
        return found && area().holds(found->point, found->lean);
    };
    std::vector<Points> out;
    for (const auto& [first, last] : ranges_where(crease.size(), [&](std::size_t k) {
             const Vec3d at = crease[k];
             return holds(at.x - away, at.y) || holds(at.x + away, at.y) ||
                    holds(at.x, at.y - away) || holds(at.x, at.y + away);
         })) {
        out.emplace_back(crease.begin() + static_cast<std::ptrdiff_t>(first),
                         crease.begin() + static_cast<std::ptrdiff_t>(last + 1));
    }
    return out;
}

void SurfaceOperation::check_surfaces()
{
    for (std::size_t k = 0; k < surfaces_.size(); ++k) {
        const Surface& s = surfaces_[k];
        constexpr int kSamples = 8;
        double area = 0;
        double most_up = 0;
        for (int i = 0; i < kSamples; ++i) {
            for (int j = 0; j < kSamples; ++j) {
                const SurfacePoint p = derivatives_at(
                    s, s.u_begin() + (s.u_end() - s.u_begin()) * (i + 0.5) / kSamples,
                    s.v_begin() + (s.v_end() - s.v_begin()) * (j + 0.5) / kSamples);
                area += norm(cross(p.du, p.dv)) * (s.u_end() - s.u_begin()) *
                        (s.v_end() - s.v_begin()) / (kSamples * kSamples);
                most_up = std::max(most_up, upward_normal(p).z);
            }
        }
        if (!(area > kLeastSize)) {
            throw InputError(fmt::format("{}: surface {} has an area of {:g} mm2, it is degenerate",
                                         file_of(operation_), k + 1, area));
        }
        upright_ += most_up < kLeastFacing ? 1 : 0;
    }
    if (upright_ > 0 && surfaces_.size() == static_cast<std::size_t>(upright_)) {
        throw InputError(fmt::format(
            "{}: every surface is vertical (no normal rises by {:g}): there is nothing to cut from "
            "above",
            file_of(operation_), kLeastFacing));
    }
}

double SurfaceOperation::outward() const
{
    return path_fitter_->band().offset + path_fitter_->band().half_width;
}

Points SurfaceOperation::add_pass(const Points& wanted,
                                  const std::optional<Curve>& exact,
                                  const CcParameterList& cc_parameters)
{
    return add(fitted_pass(wanted, exact, cc_parameters));
}

SurfaceOperation::FittedPass SurfaceOperation::fitted_pass(
    const Points& wanted,
    const std::optional<Curve>& exact,
    const CcParameterList& cc_parameters,
    const part_model::PartModel::SharedQueries::Part* queries) const
{
    GougeFreePathFitter fitter = *path_fitter_;
    if (queries != nullptr) {
        fitter.set_part(*queries);
    }
    FittedPass out;
    const Points dense = fitter.moved_clear_of_edges(wanted);
    out.moved = dense != wanted;
    SurfacePass& pass = out.pass;
    if (operation_.output == OutputForm::kNurbs) {
        pass.curve =
            !out.moved && exact && fitter.is_nurbs_clear(*exact) ? exact : fitter.fit_nurbs(dense);
    }
    if (operation_.output == OutputForm::kArcs) {
        pass.points = dense;
        pass.points.front() = fitter.raised_clear(dense.front());
        pass.moves = fitter.fit_arcs(pass.points);
        if (!pass.moves.empty()) {
            pass.points.back() = end_of(pass.moves.back());
        }
    } else if (pass.curve) {
        pass.points = dense;
        pass.points.front() = pass.curve->points.front();
        pass.points.back() = pass.curve->points.back();
    } else {
        pass.points = fitter.fit_lines(dense, out.moved ? CcParameterList{} : cc_parameters);
    }
    const bool cuts =
        pass.points.size() >= 2 && (operation_.output != OutputForm::kArcs || !pass.moves.empty());
    if (cuts) {
        out.points = path_of(pass);
    }
    out.least_clearance = fitter.least_clearance();
    return out;
}

Points SurfaceOperation::add(FittedPass fitted)
{
    moved_off_edges_ = moved_off_edges_ || fitted.moved;
    path_fitter_->include_moves_with(fitted.least_clearance);
    if (!fitted.points.empty()) {
        passes_.push_back(std::move(fitted.pass));
    }
    return std::move(fitted.points);
}

std::optional<SurfaceOperation::FittedPass> SurfaceOperation::fitted_clear_pass(
    const Points& dense, const CcParameterList& cc_parameters) const
{
    if (operation_.output != OutputForm::kLines ||
        path_fitter_->moved_clear_of_edges(dense) != dense) {
        return std::nullopt;
    }
    GougeFreePathFitter fitter = *path_fitter_;
    std::optional<Points> points = fitter.fit_clear_lines(dense, cc_parameters);
    if (!points) {
        return std::nullopt;
    }
    FittedPass out;
    out.pass.points = *points;
    out.points = std::move(*points);
    out.least_clearance = fitter.least_clearance();
    return out;
}

Points SurfaceOperation::path_of(const SurfacePass& pass) const
{
    if (!pass.curve && pass.moves.empty()) {
        return pass.points;
    }
    std::vector<ToolMove> moves = pass.moves;
    if (pass.curve) {
        moves = {{MoveKind::kCut, NurbsTo{*pass.curve}}};
    }
    Points out{pass.points.front()};
    for (const ToolMove& move : moves) {
        const Points next = points_of(move, out.back(), path_off());
        out.insert(out.end(), next.begin(), next.end());
    }
    return out;
}

double SurfaceOperation::path_off() const
{
    return operation_.output == OutputForm::kLines ? 0
                                                   : kChordOfBand * path_fitter_->band().half_width;
}

PlannedOperation SurfaceOperation::finish(double spacing, double scallop_bound, double lead_in)
{
    if (passes_.empty()) {
        throw InputError(fmt::format(
            "{}: a {} of radius {:g} mm reaches no part of the surfaces{} from above",
            file_of(operation_), operation_.tool.shape == ToolShape::kBall ? "ball" : "tool",
            operation_.tool.radius,
            area().is_everything() ? "" : " inside boundary, slopes and heights"));
    }
    LinkRules rules;
    rules.stay_down = std::max(2 * operation_.tool.radius, 4 * spacing);
    rules.clearance_z = job_.stock_top + job_.clearance;
    rules.plunge_from = job_.stock_top + kOverStock;
    rules.lead_in = lead_in;
    rules.one_way = operation_.passes.traversal == Traversal::kOneWay;
    PlannedOperation planned;
    OperationStats& stats = planned.stats;
    stats.strategy = operation_.name();
    keep_in_stock(rules.stay_down, stats);
    leave_out_idle(rules.stay_down);
    stats.passes = static_cast<int>(passes_.size());
    LinkedPasses linked;
    if (!passes_.empty()) {
        linked = link_passes(std::move(passes_), rules, *path_fitter_);
    }
    stats.levels = 1;
    stats.cl_points = linked.points;
    stats.retracts = linked.retracts;
    stats.gouge_bound_mm = std::max(0.0, -path_fitter_->least_clearance());
    stats.scallop_bound_mm = scallop_bound + operation_.part.facet_error;
    stats.counts = {{"pass_length_mm", linked.cut_length}, {"link_length_mm", linked.link_length}};
    if (upright_ > 0) {
        stats.warnings.push_back(fmt::format(
            "vertical surfaces: {} of {}; which side of them is the part is not known; they are "
            "cut where their normal points to the left of the direction of u",
            upright_, surfaces_.size()));
    }
    set_tool(planned.path, job_, operation_.tool);
    planned.path.moves = std::move(linked.moves);
    planned.path.comments = {
        operation_.name(),
        fmt::format("gouge at most {:.6f} mm, scallop at most {:.4f} mm where it reaches",
                    stats.gouge_bound_mm, stats.scallop_bound_mm)};
    return planned;
}

// If the part rises over the stock, the job is wrong: no pass is left out because of it.
void SurfaceOperation::keep_in_stock(double linked, OperationStats& stats)
{
    const double limit = job_.stock_top + kSameTop;
    if (model_->box_high().z > limit && model_->highest() > limit) {
        return;
    }
    const double over = job_.stock_top - kSameTip;
    passes_ = passes_in_stock(
        passes_, [&](Vec3d a, Vec3d b) { return std::min(a.z, b.z) >= over; }, linked);
    if (passes_.empty()) {
        stats.warnings.push_back(
            fmt::format("no surface is below the stock's top, z = {:.6g} mm: nothing is finished; "
                        "if the stock is higher, give its height (top in [stock], --stock-top)",
                        job_.stock_top));
    }
}

// None is left where another tool has cut all of the ground.
void SurfaceOperation::leave_out_idle(double linked)
{
    if (!is_idle_) {
        return;
    }
    std::vector<SurfacePass> divided;
    for (const SurfacePass& pass : passes_) {
        divided.push_back(divided_where_idle(pass, is_idle_));
    }
    passes_ = passes_in_stock(divided, is_idle_, linked);
}

void report_left_beside_edges(OperationStats& stats, double beside_edges, double scallop_bound)
{
    if (beside_edges > scallop_bound) {
        stats.counts.emplace_back("left_beside_edges_mm", beside_edges);
        stats.warnings.push_back(fmt::format(
            "slivers of up to {:.3f} mm are left beside rims and creases: with "
            "tolerance_side = \"both\" passes keep clear of edges that the ball would gouge "
            "from the side",
            beside_edges));
    }
}

void report_blocked(OperationStats& stats, const MeshLeft& left, const Tool& tool)
{
    stats.left_measured_mm = left.measured;
    if (left.blocked_area > kShownArea) {
        stats.warnings.push_back(fmt::format(
            "on {:.3g} mm2 the {} does not touch the mesh (feet of walls, concave edges, "
            "undercuts, valleys narrower than the tool): {}",
            left.blocked_area, name_of(tool.shape),
            left.measured ? fmt::format("up to {:.3g} mm is left there, measured and not proved",
                                        *left.measured)
                          : "stock is left there"));
    }
}

void report_walls_over_nothing(OperationStats& stats, double length)
{
    if (length > 0) {
        stats.counts.emplace_back("walls_over_nothing_mm", length);
    }
}

void report_uncovered_points(OperationStats& stats, std::size_t uncovered, bool unseen)
{
    if (uncovered > 0) {
        stats.warnings.push_back(
            fmt::format("{} may keep more than the scallop", counted(uncovered, "place")));
    }
    if (unseen) {
        stats.warnings.push_back(
            "too many places keep more than the scallop to examine all: no bound of the stock left "
            "is proved");
    }
}

}  // namespace cusp::finishing
