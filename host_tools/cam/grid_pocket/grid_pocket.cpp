// Checks the input, computes the roughness, then cuts layers, main path, wall and zigzags, in this
// order.
#include "host_tools/cam/grid_pocket/grid_pocket.hpp"

#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "host_tools/cam/adaptive_clearing/engagement_report.hpp"
#include "host_tools/cam/clearing/plunge_feed_limit.hpp"
#include "host_tools/cam/grid_pocket/grid_passes.hpp"
#include "host_tools/cam/grid_pocket/pocket_space.hpp"

namespace cusp::grid_pocket {

using adaptive_clearing::EngagementReport;
using clearing::limit_plunge_feed;
using job::Job;
using job::Operation;
using job::PocketRefusal;
using toolpath::OperationStats;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;

namespace {

constexpr double kDepthRounding = 1e-3;  // mm

// A grid of equal proportions that keeps max_roughness, by trial. The scallop height grows with the
// square of the distance of tracks.
std::string sufficient_grid(const PocketSpace& pocket, const PocketWalls& walls, double roughness)
{
    Operation finer = pocket.operation;
    for (int attempt = 0; attempt < 4; ++attempt) {
        const double factor = 0.98 * std::sqrt(*grid_keys(finer).max_roughness / roughness);
        grid_keys(finer).grid_x *= factor;
        grid_keys(finer).grid_y *= factor;
        if (static_cast<double>(pocket.grid.count_inside()) / (factor * factor) > 1e6) {
            break;
        }
        PocketSpace tried{pocket.job, finer, walls};
        tried.heights = heights_over(tried, tried.finish);
        roughness = roughness_of(tried, finish_navigation(tried));
        if (roughness <= *grid_keys(finer).max_roughness) {
            return "grid " + length_text(pocket.job, grid_keys(finer).grid_x) + " x " +
                   length_text(pocket.job, grid_keys(finer).grid_y) + " suffices";
        }
    }
    return "grid " + length_text(pocket.job, grid_keys(finer).grid_x) + " x " +
           length_text(pocket.job, grid_keys(finer).grid_y) + " would be needed at least";
}

void warn_of_layers(const Job& job, const LayerPlanes& planes, OperationStats& stats)
{
    if (planes.left_out > 0) {
        stats.warnings.push_back(
            "layers: " + std::to_string(planes.left_out) + " lie below " +
            length_text(job, job.stock_top - planes.lowest) +
            " under stock.top, the lowest position of the tool on this floor, and are omitted");
    }
}

void warn_of_cliffs(const PocketSpace& pocket, OperationStats& stats)
{
    if (const auto cliff = highest_cliff(pocket)) {
        const Job& job = pocket.job;
        stats.warnings.push_back("the floor steps by " + length_text(job, cliff->height) +
                                 " at x " + length_text(job, cliff->at.x) + ", y " +
                                 length_text(job, cliff->at.y) +
                                 ": beside such cliffs more stock is left than the roughness");
    }
}

void warn_of_depth(const Job& job,
                   const Operation& operation,
                   const GridPasses& planner,
                   OperationStats& stats)
{
    const double deepest = planner.deepest_cut().value_or(0);
    if (operation.levels.max_depth && deepest > *operation.levels.max_depth + kDepthRounding) {
        stats.warnings.push_back("a cut is " + length_text(job, deepest) +
                                 " deep, over max_depth " +
                                 length_text(job, *operation.levels.max_depth));
    }
}

void warn_of_entries(const ToolpathWriter& writer, OperationStats& stats)
{
    if (writer.steep_plunges() > 0) {
        stats.warnings.push_back(std::to_string(writer.steep_plunges()) +
                                 " entries have no room for a ramp and plunge straight down");
    }
    if (writer.narrow_entries() > 0) {
        stats.warnings.push_back(std::to_string(writer.narrow_entries()) +
                                 " entries have no room for a helix and ramp");
    }
}

// Fills the statistics, warnings and comments of the finished path.
void fill_report(const PocketSpace& pocket,
                 const LayerPlanes& planes,
                 const GridPasses& planner,
                 double roughness,
                 PlannedOperation& out)
{
    const Job& job = pocket.job;
    const std::size_t cells = pocket.grid.count_inside();
    OperationStats& stats = out.stats;
    stats.strategy = pocket.operation.name();
    stats.passes = planner.passes();
    stats.levels = static_cast<int>(planes.z.size()) + 1;
    stats.cl_points = static_cast<int>(out.path.moves.size());
    stats.retracts = planner.retracts();
    stats.gouge_bound_mm = pocket.finish.gouge_bound();
    const FollowSettings settings = follow_settings(pocket.operation);
    stats.scallop_bound_mm =
        roughness + (settings.arcs ? settings.arc_tolerance : settings.tolerance);
    stats.counts = {{"cells", static_cast<double>(cells)},
                    {"steps", planner.steps()},
                    {"dead_ends", planner.dead_ends()},
                    {"backtracks", planner.backtracks()},
                    {"dead_end_lifts", planner.lifts()},
                    {"main_path_moves", static_cast<double>(planner.main_moves())},
                    {"layers", static_cast<double>(planes.z.size())},
                    {"roughness_mm", roughness},
                    {"helices", planner.writer().helices()}};
    if (const auto deepest = planner.deepest_cut()) {
        stats.counts.emplace_back("deepest_cut_mm", *deepest);
        stats.counts.emplace_back("depth_passes", planner.depth_passes());
    }
    warn_of_depth(job, pocket.operation, planner, stats);
    out.path.comments = {"grid_pocket: " + std::to_string(cells) + " cells, roughness " +
                         length_text(job, roughness) + ", gouge at most " +
                         length_text(job, stats.gouge_bound_mm)};
    warn_of_layers(job, planes, stats);
    warn_of_cliffs(pocket, stats);
    warn_of_entries(planner.writer(), stats);
}

// Cuts the layers of the job; sets `layers` where their engagement is bounded, and the planes.
void cut_layers(const PocketSpace& pocket,
                GridPasses& planner,
                AdaptiveLayers& layers,
                LayerPlanes& planes)
{
    if (pocket.operation.passes.max_engagement) {
        layers = adaptive_layers(pocket);
        for (const AdaptiveLayer& layer : layers.layers) {
            planner.adaptive_layer(layers, layer);
            planes.z.push_back(layer.z);
        }
        return;
    }
    planes = layer_planes(pocket);
    for (std::size_t i = 0; i < planes.z.size(); ++i) {
        planner.layer(planes.z[i]);
        pocket.job.report_progress(0.3 + 0.2 * static_cast<double>(i + 1) /
                                             static_cast<double>(planes.z.size()));
    }
}

void report_engagement(const AdaptiveLayers& layers,
                       const GridPasses& planner,
                       OperationStats& stats)
{
    EngagementReport engagement{layers.max_engagement};
    for (const AdaptiveLayer& layer : layers.layers) {
        engagement.add(layer.path, 1, layer.z);
    }
    stats.counts.emplace_back("entries", planner.adaptive_entries());
    stats.counts.emplace_back("lifts", planner.retracts());
    engagement.write(stats);
}

}  // namespace

std::vector<PlannedOperation> plan_grid_pocket(const Job& job, const Operation& operation)
{
    const auto start = std::chrono::steady_clock::now();
    check_grid_input(job, operation);
    const PocketWalls walls = pocket_walls(job, operation);
    check_grid_floor(job, operation, walls.region);
    PocketSpace pocket{job, operation, walls};
    if (pocket.centres.contours.empty()) {
        throw PocketRefusal(job.file + ": grid_pocket: no place in the pocket is " +
                            length_text(job, pocket.kept) +
                            " from its walls: the tool does not fit");
    }
    pocket.heights = heights_over(pocket, pocket.finish);
    const Navigation navigation = finish_navigation(pocket);
    job.report_progress(0.2);
    const double roughness = roughness_of(pocket, navigation);
    job.report_progress(0.3);
    if (grid_keys(operation).max_roughness && roughness > *grid_keys(operation).max_roughness) {
        refuse_grid_pocket(job, "roughness " + length_text(job, roughness) +
                                    " is over max_roughness " +
                                    length_text(job, *grid_keys(operation).max_roughness) + "; " +
                                    sufficient_grid(pocket, walls, roughness));
    }
    PlannedOperation out;
    set_tool(out.path, job, operation.tool);
    GridPasses planner{pocket, out.path};
    LayerPlanes planes{};
    AdaptiveLayers layers;
    if (!operation.levels.layers.empty() || operation.levels.max_depth) {
        pocket.rough_heights =
            pocket.rough_allowance > 0 ? heights_over(pocket, pocket.rough) : pocket.heights;
        cut_layers(pocket, planner, layers, planes);
    }
    job.report_progress(0.5);
    planner.main_path(navigation);
    job.report_progress(0.9);
    planner.wall();
    Tracks tracks = tracks_of(pocket.grid, navigation);
    for (const char axis : grid_keys(operation).zigzag) {
        planner.zigzag(axis, tracks);
    }
    planner.finish();
    job.report_progress(1);
    fill_report(pocket, planes, planner, roughness, out);
    if (operation.passes.max_engagement) {
        report_engagement(layers, planner, out.stats);
    }
    std::vector<PlannedOperation> result;
    result.push_back(std::move(out));
    limit_plunge_feed(result, job, box_of(walls.region));
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    result.back().stats.planning_s = spent.count();
    return result;
}

}  // namespace cusp::grid_pocket
