// Plans the finish: passes by the floor's stepover, in the paper's order. Roughing layers precede
// it.
#include "host_tools/cam/contour_pocket/contour_pocket.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/clearing/clearing.hpp"
#include "host_tools/cam/clearing/partial_loops.hpp"
#include "host_tools/cam/clearing/plunge_feed_limit.hpp"
#include "host_tools/cam/contour_pocket/adaptive_pocket.hpp"
#include "host_tools/cam/contour_pocket/loop_scallop.hpp"
#include "host_tools/cam/contour_pocket/loop_spacing.hpp"
#include "host_tools/cam/contour_pocket/loops_in_strip.hpp"
#include "host_tools/cam/contour_pocket/pencil_detours.hpp"
#include "host_tools/cam/contour_pocket/pencil_passes.hpp"
#include "host_tools/cam/contour_pocket/pocket_path_writer.hpp"
#include "host_tools/cam/contour_pocket/pocket_report.hpp"
#include "host_tools/cam/contour_pocket/pocket_task.hpp"
#include "host_tools/cam/contour_pocket/rough_layers.hpp"
#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/job/job/level_floor.hpp"

namespace cusp::contour_pocket {

using cl_path::flattened;
using cl_path::repeated_plan_tolerance;
using clearing::AxialDepthTracker;
using clearing::ClearedRegion;
using clearing::ClearingPass;
using clearing::ClearingSettings;
using clearing::kMaxRings;
using clearing::limit_plunge_feed;
using clearing::LoopStrip;
using drop_cutter::DropCutter;
using job::Job;
using job::kRoughingDone;
using job::level_floor;
using job::Operation;
using job::OutputForm;
using job::PocketRefusal;
using offset::area;
using offset::Contour;
using offset::Edge;
using offset::EdgeTree;
using offset::length;
using offset::Region2d;
using offset::RegionOffset;
using toolpath::OperationStats;
using toolpath::PlannedOperation;
using toolpath::Tool;
using toolpath::Toolpath;

namespace {

// mm: the largest rise of the profile of `tool` above that of `other` on one axis: how far above
// its tip `tool` leaves stock that `other` cuts.
double highest_over(const Tool& tool, const Tool& other)
{
    constexpr int kPlaces = 16;
    double highest = 0.0;
    for (int i = 1; i <= kPlaces; ++i) {
        const double out = std::min(tool.radius, other.radius) * i / kPlaces;
        highest = std::max(highest, profile_height(tool, out) - profile_height(other, out));
    }
    return highest;
}

// Limits of the cost of partial loops, as shares of the path length with entries. At cliffs partial
// loops leave more stock.
constexpr double kDoubtful = 0.5;
constexpr double kWorthIt = 0.97;
constexpr double kWorthItAtCliffs = 0.8;

constexpr double kLevelsDone = 0.6;  // of the progress, where nothing is roughed

constexpr double kStockPitch = 1.0 / 24;  // of the finest tool's radius

// True if the floor is one surface without trims, which has no cliffs.
bool is_one_whole_surface(const Operation& operation)
{
    return operation.part.floor.size() == 1 && operation.part.floor.front().trims.empty();
}

class FinishPlanner {
public:
    FinishPlanner(const Pocket& pocket, AxialDepthTracker* depth)
        : pocket_{pocket},
          operation_{pocket.operation},
          walls_{pocket.region},
          floor_{operation_.part.floor, operation_.tool, pocket.tolerances.accuracy},
          loop_scallop_{floor_, operation_.part.floor, pocket.tolerances},
          moves_{pocket.job.stock_top + pocket.job.clearance},
          depth_{depth},
          begun_{is_roughed(operation_) ? kRoughingDone : 0.0},
          levels_done_{is_roughed(operation_) ? 0.0 : kLevelsDone}
    {
        if (!pocket.tolerances.one_sided) {
            floor_.check_edge_gouges(operation_.tolerance.floor);
        }
    }

    const DropCutter& floor() const { return floor_; }

    // Finds the passes, which do not depend on roughing. Errors: those of plan_contour_pocket().
    void find_passes()
    {
        cleared_ = passes();
        pencils_ = find_pencil_passes(cleared_);
    }

    // After find_passes().
    //
    // rough  the operations cut before; null for whole stock
    PlannedOperation plan(const RoughResult* rough)
    {
        ClearedRegion& cleared = cleared_;
        std::vector<ClearingPass>& pencils = pencils_;
        report(levels_done_);
        loops_ = static_cast<int>(cleared.passes.size());
        pencil_passes_ = static_cast<int>(pencils.size());
        const bool last_layer = finish_is_last_layer(operation_);
        if ((rough == nullptr || last_layer) && cleared.saved > 0.0) {
            put_in_partial_loops(cleared);
            pencils = add_pencil_detours(
                cleared, pencils, walls_,
                pocket_.tolerances.wall_clearance - pocket_.tolerances.plan_tolerance,
                operation_.tool.radius);
        }
        add_pencil_passes(cleared, pencils, reach_of(walls_, pocket_.tolerances.wall_clearance));
        PocketPathWriter cutter{operation_, floor_, walls_, moves_, depth_};
        if (depth_ != nullptr) {
            depth_->begin(operation_.tool);
        }
        CutSettings settings =
            cutting(rough != nullptr ? std::optional{rough->left} : std::nullopt);
        settings.repeated = pencil_settings(cleared);
        if (last_layer) {
            const double above = rough != nullptr ? rough->heights.back() : pocket_.job.stock_top;
            settings.depth_share = 1.0;
            settings.entry_heights = [above](double pass) {
                return heights_over(std::max(above, pass));
            };
        } else if (rough != nullptr) {
            settings.repeated = beside_roughing(cleared, *rough);
            flatten(cleared, settings);
            end_with_partial_loops(cleared);
            settings.rapid_to_stock = true;
            settings.skipped = cut_by_roughing(cleared, settings.repeated, *rough);
            const bool stock_left = operation_.passes.allowance > 0.0 ||
                                    operation_.passes.max_engagement ||
                                    rough->operation.path.tool.number != operation_.tool.number;
            if (stock_left) {
                settings.stock_beside = {stock_beside(cleared, settings.repeated),
                                         pocket_.job.stock_top, depths_beside(cleared, *rough)};
            }
        }
        settings.retracts = cleared.leaves + static_cast<int>(operation_.outline.islands.size());
        settings.progress = [&](double share) {
            report(levels_done_ + (1.0 - levels_done_) * share);
        };
        cutter.cut(cleared, settings);
        cutter.end();
        PlannedOperation result;
        fill(result.stats, cleared, cutter.least_clearance());
        describe(result.path, result.stats);
        result.path.moves = moves_.take();
        return result;
    }

private:
    void report(double share) const { pocket_.job.report_progress(share, begun_); }

    ClearedRegion passes()
    {
        ClearingSettings settings;
        settings.wall_clearance = pocket_.tolerances.wall_clearance;
        const double widest = finish_is_last_layer(operation_)
                                  ? rough_stepover(operation_)
                                  : operation_.passes.step_over.value_or(kUnbounded);
        settings.stepover = std::min(2.0 * operation_.tool.radius, widest);
        settings.direction = operation_.passes.direction_of_cut;
        settings.cover_corners = *operation_.tolerance.scallop > operation_.tolerance.floor;
        const bool corners = settings.cover_corners;
        const bool whole = is_one_whole_surface(operation_);
        LoopSpacing interval{floor_, pocket_.tolerances, corners && !whole, !corners || !whole};
        settings.stepover_from = [&, whole_area = area(pocket_.region)](const Region2d& ring) {
            if (levels_done_ > 0.0) {
                report(levels_done_ * (1.0 - area(ring) / whole_area));
            }
            return std::min(
                widest, interval.stepover_from(
                            ring, corners && whole ? loop_scallop_.proven_stepover(ring) : 0.0));
        };
        if (corners && whole) {
            settings.scallop_share_between = [&](const LoopStrip& strip) {
                return loop_scallop_.relative_scallop(strip);
            };
        }
        if (corners) {
            settings.partial_stepover = [&](const Region2d& ring, double step) {
                return interval.with_partial_loops(ring, step);
            };
            settings.partial_loops = [&](const LoopStrip& strip, double max_length) {
                return loops_in_strip(strip, loop_scallop_, operation_.tool.radius, max_length);
            };
        }
        ClearedRegion cleared = clear_region(pocket_.region, settings);
        if (cleared.saved > 0.0 && cleared.saved < kDoubtful * length(cleared)) {
            settings.partial_stepover = nullptr;
            ClearedRegion by_loops = clear_region(pocket_.region, settings);
            const double slope =
                (pocket_.job.stock_top - lowest_tip(by_loops, floor_)) / kEntrySlope;
            const auto cost = [&](const ClearedRegion& c) {
                return length(c) + slope * c.leaves;
            };
            if (cost(cleared) > (whole ? kWorthIt : kWorthItAtCliffs) * cost(by_loops)) {
                cleared = std::move(by_loops);
            }
        }
        if (cleared.passes.empty()) {
            throw PocketRefusal(no_room_text(operation_));
        }
        if (cleared.rings >= kMaxRings) {
            throw InputError(operation_text(pocket_.job, operation_) + "scallop " +
                             number_text(*operation_.tolerance.scallop) + " mm makes " +
                             number_text(cleared.rings) + " levels of loops, the limit is " +
                             number_text(kMaxRings - 1));
        }
        return cleared;
    }

    std::vector<ClearingPass> find_pencil_passes(const ClearedRegion& cleared) const
    {
        if (is_one_whole_surface(operation_)) {
            return {};
        }
        ClearedRegion all = cleared;
        put_in_partial_loops(all);
        PencilSettings settings;
        settings.wall_clearance = pocket_.tolerances.wall_clearance;
        settings.max_uncut = pocket_.tolerances.scallop_height;
        settings.path_settings = cutting(std::nullopt).path_settings;
        settings.path_settings.plan_tolerance =
            repeated_plan_tolerance(pocket_.tolerances.plan_tolerance);
        settings.distance = settings.path_settings.plan_tolerance + pocket_.tolerances.accuracy;
        settings.fragments = cleared.saved == 0.0;
        return pencil_passes(pocket_.region, floor_, all, settings);
    }

    static std::vector<bool> pencil_settings(const ClearedRegion& cleared)
    {
        std::vector<bool> result;
        for (const ClearingPass& pass : cleared.passes) {
            result.push_back(pass.is_pencil);
        }
        return result;
    }

    // Leaves pencil passes out where the stock height map is known: the loops before them have cut
    // that stock.
    std::vector<bool> stock_beside(const ClearedRegion& cleared, std::vector<bool> beside) const
    {
        for (std::size_t i = 0; operation_.levels.max_depth && i < beside.size(); ++i) {
            beside[i] = beside[i] && !cleared.passes[i].is_pencil;
        }
        return beside;
    }

    // Which passes meet stock that roughing has not reached: the allowance beside walls, and
    // corners, necks and valleys too narrow for its tool. Its loops also leave stock at cliffs.
    std::vector<bool> beside_roughing(const ClearedRegion& cleared, const RoughResult& rough) const
    {
        const double radius = operation_.tool.radius;
        const Tool& tool = rough.operation.path.tool;
        const double larger = tool.radius - radius;
        const EdgeTree centres{edges_of(walls_.at(rough.wall_clearance))};
        const DropCutter roughed_floor{operation_.part.floor, tool, pocket_.tolerances.accuracy};
        const double depth = layer_depth(operation_);
        const double higher = rough.left + highest_over(tool, operation_.tool);
        const double max_error = 0.02 * radius;
        const auto fits = [&](Vec2d p) {
            if (walls_.clearance(p) >= rough.wall_clearance - std::min(larger, 0.0)) {
                return true;
            }
            return larger > 0.0 && centres.any_nearer(p, larger);
        };
        const double bottom = rough.heights.empty() ? pocket_.job.stock_top : rough.heights.back();
        const auto roughed = [&](Vec2d p) {
            const double left = std::max(roughed_floor.tip_height(p, max_error), bottom) + higher;
            return fits(p) && left < floor_.tip_height(p, max_error) + depth;
        };
        std::vector<bool> beside;
        for (const ClearingPass& pass : cleared.passes) {
            beside.push_back(pass.ring == 0 || pass.is_pencil);
            for (const Edge& edge : pass.path) {
                const int n = 1 + static_cast<int>(length(edge) / (0.25 * radius));
                for (int i = 0; i < n && !beside.back(); ++i) {
                    beside.back() = !roughed(point_on(edge, static_cast<double>(i) / n));
                }
            }
        }
        return beside;
    }

    // Over a level floor a flat mill without allowance leaves nothing to passes away from other stock.
    std::vector<bool> cut_by_roughing(const ClearedRegion& cleared,
                                      const std::vector<bool>& beside,
                                      const RoughResult& rough) const
    {
        std::vector<bool> cut(cleared.passes.size(), false);
        const bool whole = operation_.prismatic && operation_.passes.allowance <= 0.0 &&
                           rough.operation.path.tool.corner_radius <= 0.0 && !rough.heights.empty();
        for (std::size_t i = 0; whole && i < cut.size(); ++i) {
            cut[i] = !beside[i] && cleared.passes[i].final_path.empty();
        }
        return cut;
    }

    // Depths for passes beside such stock: those of roughing, and more for the finishing tool,
    // which goes deeper.
    std::vector<double> depths_beside(const ClearedRegion& cleared, const RoughResult& rough) const
    {
        std::vector<double> heights = rough.heights;
        const double depth = layer_depth(operation_);
        const double bottom = lowest_tip(cleared, floor_);
        double above = heights.empty() ? pocket_.job.stock_top : heights.back();
        const int n = layer_count(pocket_, above - bottom, depth);
        const double step = (above - bottom) / n;
        for (int i = 1; i < n; ++i) {
            above -= step;
            heights.push_back(above);
        }
        return heights;
    }

    // Pencil passes already keep closer to their plan path.
    void flatten(ClearedRegion& cleared, const CutSettings& settings) const
    {
        for (std::size_t i = 0; i < cleared.passes.size(); ++i) {
            if (settings.repeated[i] && !cleared.passes[i].is_pencil) {
                Contour& path = cleared.passes[i].path;
                path = flattened(path, settings.path_settings.plan_tolerance,
                                 settings.path_settings.spacing, settings.path_settings.arcs);
            }
        }
    }

    CutSettings cutting(std::optional<double> roughed) const
    {
        const double radius = operation_.tool.radius;
        CutSettings settings;
        settings.path_settings.plan_tolerance = pocket_.tolerances.plan_tolerance;
        settings.path_settings.height_tolerance = pocket_.tolerances.height_tolerance;
        settings.path_settings.one_sided = pocket_.tolerances.one_sided;
        settings.path_settings.clearance_reserve = pocket_.tolerances.accuracy;
        settings.path_settings.spacing = std::clamp(
            std::sqrt(3.0 * radius * pocket_.tolerances.height_tolerance), 0.05 * radius, radius);
        // The accuracy of lookups.
        settings.path_settings.lookup_spacing =
            loop_scallop_.lookup_spacing(pocket_.region, 0.5 * pocket_.tolerances.accuracy);
        settings.path_settings.arcs = operation_.output != OutputForm::kLines;
        settings.path_settings.nurbs = operation_.output == OutputForm::kNurbs;
        settings.entry = operation_.passes.entry;
        settings.wall_clearance = pocket_.tolerances.wall_clearance;
        // Between its loops on a slope, roughing leaves the deepest stock where it is narrowest.
        settings.depth_share = 0.7;
        const double top = pocket_.job.stock_top;
        settings.entry_heights = [top, roughed](double pass) {
            const double highest = std::max(top, pass);
            // Stock left by roughing is entered at the plunge feed: beside walls it has full
            // height.
            const double slope = roughed ? std::min(highest, pass + *roughed + 0.5) : highest;
            return EntryHeights{heights_over(highest).rapid, heights_over(slope).stock_top};
        };
        return settings;
    }

    void fill(OperationStats& stats, const ClearedRegion& cleared, double clearance) const
    {
        stats.strategy = operation_.name();
        stats.passes = loops_ + pencil_passes_;
        stats.levels = cleared.rings;
        stats.cl_points = moves_.points();
        stats.retracts = moves_.retracts();
        stats.gouge_bound_mm = std::max(0.0, -clearance);
        stats.scallop_bound_mm = pocket_.tolerances.scallop_height + operation_.tolerance.floor;
        stats.counts = {{"loops", static_cast<double>(loops_)},
                        {"leaves", static_cast<double>(cleared.leaves)},
                        {"islands", static_cast<double>(operation_.outline.islands.size())}};
        if (!cleared.partial.empty()) {
            stats.counts.emplace_back("partial_loops", static_cast<double>(cleared.partial.size()));
        }
        if (pencil_passes_ > 0) {
            stats.counts.emplace_back("cliff_passes", static_cast<double>(pencil_passes_));
        }
        report_plunges(moves_.steep_plunges(), stats);
        report_air(moves_.moves(), pocket_.job.stock_top, stats);
        if (depth_ != nullptr) {
            report_depth(*depth_, stats);
        }
        report_uncut(pocket_, walls_, floor_, !loop_scallop_.reaches_floor(pocket_.region), {},
                     stats);
    }

    void describe(Toolpath& path, const OperationStats& stats) const
    {
        set_tool(path, pocket_.job, operation_.tool);
        path.comments = {"contour_pocket: Suh and Lee 1990, " + number_text(stats.levels) +
                             (stats.levels == 1 ? " level, " : " levels, ") +
                             number_text(stats.passes) + (stats.passes == 1 ? " loop" : " loops"),
                         "left at most " + number_text(stats.scallop_bound_mm) +
                             " mm, gouge at most " + number_text(stats.gouge_bound_mm) + " mm"};
    }

    const Pocket& pocket_;
    const Operation& operation_;  // of the pocket
    RegionOffset walls_;
    DropCutter floor_;
    LoopScallop loop_scallop_;
    ClPathWriter moves_;
    AxialDepthTracker* depth_;
    // Shares of the progress that are done before the finish, and before its passes are written.
    // Beside roughing, which reports its own, passes are found without a report.
    double begun_;
    double levels_done_;
    ClearedRegion cleared_;
    std::vector<ClearingPass> pencils_;
    int loops_{0};
    int pencil_passes_{0};
};

AxialDepthTracker depth_over(const Pocket& pocket)
{
    const Operation& operation = pocket.operation;
    const Tool& rougher = operation.tools.empty() ? operation.tool : operation.tools.front();
    const bool finer = rougher.radius < operation.tool.radius;
    return {box_of(pocket.region), finer ? rougher : operation.tool, pocket.job.stock_top,
            operation.levels.max_depth, kStockPitch};
}

// Roughing in layers where the operation asks for it, and a finish by loops.
std::vector<PlannedOperation> plan_loops(const Pocket& pocket)
{
    check_work(pocket);
    const Operation& operation = pocket.operation;
    std::optional<AxialDepthTracker> depth;
    // Entries beside cliffs of the floor and beside stock left by roughing depend on the stock
    // height.
    if (is_roughed(operation) || !is_one_whole_surface(operation)) {
        depth.emplace(depth_over(pocket));
    }
    AxialDepthTracker* const cut_depth = depth ? &*depth : nullptr;
    const RoughAndFinish shared = split_between_rough_and_finish(pocket);
    FinishPlanner finish{shared.finish, cut_depth};
    check_coverage(operation, pocket.region, finish.floor());
    std::optional<RoughResult> rough;
    parallel::both([&] { rough = plan_rough_layers(shared.rough, cut_depth); },
                   [&] { finish.find_passes(); });
    std::vector<PlannedOperation> result;
    const bool nothing_roughed = rough && rough->operation.path.moves.empty();
    if (rough && !nothing_roughed) {
        result.push_back(rough->operation);
    }
    result.push_back(finish.plan(rough ? &*rough : nullptr));
    limit_plunge_feed(result, pocket.job, box_of(pocket.region));
    if (nothing_roughed) {
        const Tool& tool = rough->operation.path.tool;
        result.back().stats.warnings.push_back(
            "tool " + number_text(tool.number) + " of radius " + number_text(tool.radius) +
            " mm fits nowhere, or the stock is no higher than the allowance, " +
            number_text(operation.passes.allowance) + " mm: nothing is roughed");
    }
    return result;
}

}  // namespace

std::vector<PlannedOperation> plan_contour_pocket(const Job& job, const Operation& operation)
{
    const auto begin = std::chrono::steady_clock::now();
    const Pocket pocket{job, operation};
    std::vector<PlannedOperation> result = operation.passes.max_engagement && level_floor(operation)
                                               ? plan_adaptive_pocket(pocket)
                                               : plan_loops(pocket);
    const double roughing_s = result.size() > 1 ? result.front().stats.planning_s : 0.0;
    const auto end = std::chrono::steady_clock::now();
    result.back().stats.planning_s =
        std::chrono::duration<double>(end - begin).count() - roughing_s;
    return result;
}

}  // namespace cusp::contour_pocket
