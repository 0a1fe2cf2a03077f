// The passes are planned once, in plan, and written at each height.
#include "host_tools/cam/contour_pocket/adaptive_pocket.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"
#include "host_tools/cam/adaptive_clearing/adaptive_path_writer.hpp"
#include "host_tools/cam/adaptive_clearing/engagement_report.hpp"
#include "host_tools/cam/adaptive_clearing/wall_budget.hpp"
#include "host_tools/cam/cl_path/cl_path.hpp"
#include "host_tools/cam/contour_pocket/open_sides.hpp"
#include "host_tools/cam/contour_pocket/pocket_report.hpp"
#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"
#include "host_tools/job/job/level_floor.hpp"

namespace cusp::contour_pocket {

using adaptive_clearing::AdaptivePath;
using adaptive_clearing::AdaptivePathWriter;
using adaptive_clearing::AdaptiveSettings;
using adaptive_clearing::clear_adaptively;
using adaptive_clearing::EngagementReport;
using adaptive_clearing::room_for;
using adaptive_clearing::shares_of;
using adaptive_clearing::WallShares;
using cl_path::kWrittenStep;
using drop_cutter::DropCutter;
using job::CutLevels;
using job::EntryKind;
using job::Job;
using job::level_floor;
using job::Operation;
using job::OutputForm;
using job::PocketRefusal;
using offset::Region2d;
using offset::RegionOffset;
using toolpath::OperationStats;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;

namespace {

constexpr double kDegrees = kPi / 180.0;
constexpr double kLevel = 1e-6;  // mm: layers that differ by less are one

std::vector<double> heights_of(const Pocket& pocket)
{
    const CutLevels& levels = pocket.operation.levels;
    const double floor = level_floor(pocket.operation).value();
    const double top = pocket.job.stock_top;
    const double deep = top - floor;
    std::vector<double> heights;
    for (const double below : levels.layers) {
        if (below < deep - kLevel) {
            heights.push_back(top - below);
        }
    }
    const int n = levels.layers.empty() && levels.max_depth && deep > 0.0
                      ? layer_count(pocket, deep, *levels.max_depth)
                      : 1;
    for (int i = 1; i < n; ++i) {
        heights.push_back(top - deep * i / n);
    }
    heights.push_back(floor);
    return heights;
}

// Shares the plan tolerance between the chords and what stays beside walls; with a tolerance to one side the path keeps
// as far away from them as chords and fits may bulge.
//
// Errors: InputError where the tool is too large for the tolerance.
WallShares share_tolerance(Pocket& pocket)
{
    const Operation& operation = pocket.operation;
    ToleranceSplit& tolerances = pocket.tolerances;
    const double radius = operation.tool.radius;
    const double apart = tolerances.one_sided ? 2.0 * kWrittenStep : 0.0;
    const double fits = (tolerances.one_sided ? 2.0 : 1.0) * tolerances.fit;
    const double room = operation.tolerance.plan - fits - apart;
    const WallShares shares = shares_of(room, radius, tolerances.one_sided);
    if (shares.chords < kWrittenStep) {
        throw InputError(operation_text(pocket.job, operation) + "plan_tolerance " +
                         number_text(operation.tolerance.plan) +
                         " mm is finer than clearing \"adaptive\" keeps with a tool of radius " +
                         number_text(radius) + " mm: it leaves up to " +
                         number_text(room_for(kWrittenStep, radius)) +
                         " mm beside walls; clear by contours");
    }
    if (tolerances.one_sided) {
        tolerances.wall_clearance = radius + tolerances.fit + shares.chords + apart;
    }
    return shares;
}

AdaptivePath passes_of(const Pocket& pocket,
                       WallShares shares,
                       const std::optional<OpenSides>& open)
{
    const Operation& operation = pocket.operation;
    AdaptiveSettings settings;
    settings.tool_radius = operation.tool.radius;
    settings.wall_clearance = pocket.tolerances.wall_clearance;
    settings.max_engagement = *operation.passes.max_engagement * kDegrees;
    settings.tolerance = shares.chords;
    settings.sliver = shares.sliver;
    settings.corner = pocket.tolerances.plan_tolerance;
    settings.direction = operation.passes.direction_of_cut;
    if (open) {
        settings.open.push_back(open->starts);
    }
    settings.progress = [&](double share) {
        pocket.job.report_progress(share);
    };
    AdaptivePath path = clear_adaptively(pocket.region, settings);
    if (path.runs.empty()) {
        throw PocketRefusal(no_room_text(operation));
    }
    return path;
}

}  // namespace

// The swept area is kept in cells of a twelfth of the radius.
void check_adaptive_size(const Operation& operation, const Region2d& region)
{
    constexpr double kMostCells = 2e7;
    const double pitch = operation.tool.radius / 12.0;
    const offset::Box2d box = box_of(region);
    const double x = box.x1 - box.x0;
    const double y = box.y1 - box.y0;
    if (x * y > kMostCells * pitch * pitch) {
        throw InputError(
            operation.outline.boundary_file + ": the pocket of " + number_text(x) + " x " +
            number_text(y) + " mm is over " + number_text(kMostCells * pitch * pitch) +
            " mm^2, the most that clearing \"adaptive\" takes with the tool of radius " +
            number_text(operation.tool.radius) + " mm");
    }
}

// Over 60 lines: the steps of one plan, in order, share its settings.
std::vector<PlannedOperation> plan_adaptive_pocket(Pocket pocket)
{
    const Job& job = pocket.job;
    const Operation& operation = pocket.operation;
    const WallShares shares = share_tolerance(pocket);
    const std::optional<OpenSides> open =
        open_sides(job, operation, pocket.region, pocket.tolerances.wall_clearance);
    const bool beside_stock = lies_beside_stock(job, pocket.region);
    const DropCutter floor{operation.part.floor, operation.tool, pocket.tolerances.accuracy};
    const Region2d in_stock = open ? open->in_stock : pocket.region;
    if (open) {
        pocket.region = open->region;
    }
    check_work(pocket);
    check_adaptive_size(operation, pocket.region);
    check_coverage(operation, in_stock, floor);
    const std::vector<double> heights = heights_of(pocket);
    const AdaptivePath path = passes_of(pocket, shares, open);

    PlannedOperation result;
    set_tool(result.path, job, operation.tool);
    ToolpathWriter writer{
        result.path.moves,
        {job.stock_top + job.clearance, operation.passes.entry, operation.tool.radius}};
    AdaptivePathWriter cutter{writer,
                              {operation.output != OutputForm::kLines, shares.chords,
                               operation.passes.entry == EntryKind::kPlunge}};
    double above = job.stock_top;
    for (const double z : heights) {
        cutter.write(path, above, z);
        above = z;
    }
    writer.retract();
    OperationStats& stats = result.stats;
    stats.strategy = operation.name();
    stats.passes = static_cast<int>(path.runs.size() * heights.size());
    stats.levels = static_cast<int>(heights.size());
    stats.cl_points = cutter.points();
    stats.retracts = writer.retracts();
    stats.scallop_bound_mm = operation.tolerance.floor;
    stats.counts = {{"layers", static_cast<double>(heights.size())},
                    {"islands", static_cast<double>(operation.outline.islands.size())},
                    {"entries", static_cast<double>(cutter.entries())},
                    {"lifts", static_cast<double>(writer.retracts())}};
    EngagementReport engagement{*operation.passes.max_engagement};
    engagement.add(path, heights.size());
    engagement.write(stats);
    if (open) {
        stats.counts.emplace_back("open_pocket", 1.0);
    }
    report_plunges(cutter.plunges(), stats);
    report_air(result.path.moves, job.stock_top, stats);
    if (beside_stock) {
        stats.warnings.push_back(operation.outline.boundary_file +
                                 ": the pocket lies beside the stock: the program cuts none");
    }
    report_uncut(pocket, RegionOffset{pocket.region}, floor, false, open ? open->air : Region2d{},
                 stats);
    result.path.comments = {"contour_pocket: adaptive clearing, engagement at most " +
                            number_text(path.engagement_bound / kDegrees) + " degrees"};
    return {std::move(result)};
}

}  // namespace cusp::contour_pocket
