// Every layer has the same loops; where the floor is above a layer the tool follows the floor.
#include "host_tools/cam/contour_pocket/rough_layers.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "host_tools/cam/contour_pocket/adaptive_rough_layers.hpp"
#include "host_tools/cam/contour_pocket/pocket_path_writer.hpp"

namespace cusp::contour_pocket {

using cl_path::flattened;
using clearing::AxialDepthTracker;
using clearing::ClearedRegion;
using clearing::ClearingPass;
using clearing::ClearingSettings;
using drop_cutter::DropCutter;
using job::CutLevels;
using job::Job;
using job::kRoughingDone;
using job::Operation;
using job::OutputForm;
using offset::Edge;
using offset::RegionOffset;
using toolpath::OperationStats;
using toolpath::Tool;

namespace {

constexpr double kStepOfDepth = 0.2;  // of adaptive levels

struct RoughStep {
    double across;          // mm between loops
    double scallop_height;  // mm left between them
};

// Scallops of a ball are limited to a fifth of the depth of cut, so that the next layer is little
// deeper than requested.
RoughStep rough_step(const Tool& tool, double depth)
{
    const double c = tool.corner_radius;
    const double flat = 1.2 * (tool.radius - c);
    const double scallop_height = std::min(0.2 * depth, 0.13 * c);
    const double round =
        2.0 * std::sqrt(std::max(0.0, scallop_height * (2.0 * c - scallop_height)));
    return {std::max(flat, std::min(round, c)), flat > round ? 0.0 : scallop_height};
}

std::vector<double> layer_heights(const Pocket& pocket, double bottom, double depth)
{
    const CutLevels& levels = pocket.operation.levels;
    const double top = pocket.job.stock_top;
    std::vector<double> heights;
    for (const double below : levels.layers) {
        heights.push_back(top - below);
    }
    if (heights.empty()) {
        const double deep = top - bottom;
        int n = layer_count(pocket, deep, depth);
        if (const double least = levels.min_depth.value_or(0.0); deep < n * least) {
            // Fewer layers, as far as max_depth allows: passes that become too deep over scallops
            // of the layer above are cut twice.
            n = std::max(layer_count(pocket, deep, *levels.max_depth),
                         static_cast<int>(deep / least + 1e-9));
        }
        for (int i = 1; i <= n; ++i) {
            heights.push_back(top - deep * i / n);
        }
    }
    std::sort(heights.begin(), heights.end(), [](double a, double b) { return a > b; });
    return heights;
}

// max_depth has priority over min_depth.
void warn_of_thin_layers(const Pocket& pocket, RoughResult& result)
{
    const double deep =
        result.heights.empty() ? 0.0 : pocket.job.stock_top - result.heights.front();
    const double least = pocket.operation.levels.min_depth.value_or(0.0);
    if (deep < least - 1e-6) {
        result.operation.stats.warnings.push_back(
            "layers are " + number_text(deep) + " mm deep, less than min_depth, " +
            number_text(least) + " mm: max_depth and the depth of the pocket allow no others");
    }
}

CutSettings rough_settings(const Pocket& pocket, double wall_clearance)
{
    const Operation& operation = pocket.operation;
    const ToleranceSplit& tolerances = pocket.tolerances;
    CutSettings settings;
    settings.entry = operation.passes.entry;
    settings.wall_clearance = wall_clearance;
    settings.path_settings.plan_tolerance = tolerances.plan_tolerance;
    settings.path_settings.height_tolerance =
        std::max(tolerances.height_tolerance, 0.1 * operation.passes.allowance);
    settings.path_settings.clearance_reserve = tolerances.accuracy;
    settings.path_settings.allowance = operation.passes.allowance;
    settings.path_settings.spacing = 0.2 * operation.tool.radius;
    settings.path_settings.arcs = operation.output != OutputForm::kLines;
    return settings;
}

// Fills path and statistics, except the gouge bound and the time; takes the moves.
void fill_operation(const Operation& operation,
                    const ClearedRegion& cleared,
                    ClPathWriter& moves,
                    RoughResult& result)
{
    const std::size_t layers = result.heights.size();
    result.operation.path.comments = {
        "contour_pocket: " +
        (layers == 1 ? "1 roughing layer" : std::to_string(layers) + " roughing layers") +
        ", allowance " + number_text(operation.passes.allowance) + " mm"};
    OperationStats& stats = result.operation.stats;
    stats.strategy = operation.name();
    stats.roughing = true;
    stats.passes = static_cast<int>(cleared.passes.size());
    stats.levels = cleared.rings;
    stats.cl_points = moves.points();
    stats.retracts = moves.retracts();
    stats.scallop_bound_mm = result.left;
    stats.counts = {{"layers", static_cast<double>(layers)},
                    {"loops", static_cast<double>(cleared.passes.size())},
                    {"leaves", static_cast<double>(cleared.leaves)},
                    {"islands", static_cast<double>(operation.outline.islands.size())}};
    report_plunges(moves.steep_plunges(), stats);
    result.operation.path.moves = moves.take();
}

// Layers of bounded engagement, for all that lies above `bottom` (z of the tip) by more than half a step.
void fill_adaptively(const Pocket& pocket, double bottom, RoughResult& result)
{
    const double depth = layer_depth(pocket.operation);
    const double step = kStepOfDepth * depth;
    const double scallops = kStepOfDepth * std::min(depth, pocket.operation.tool.corner_radius);
    result.heights = layer_heights(pocket, std::min(bottom + 0.5 * step, pocket.job.stock_top),
                                   std::max(0.1 * depth, depth - scallops));
    rough_adaptively(pocket, step, result);
}

// Cuts the loops at every height.
//
// retracts  allowed for each layer
void cut_layers(const Job& job,
                const ClearedRegion& cleared,
                const std::vector<double>& heights,
                int retracts,
                CutSettings settings,
                PocketPathWriter& cutter)
{
    double above = job.stock_top;
    for (std::size_t layer = 0; layer < heights.size(); ++layer) {
        job.report_progress(kRoughingDone * static_cast<double>(layer) /
                            static_cast<double>(heights.size()));
        settings.path_settings.min_z = heights[layer];
        settings.retracts += retracts;
        settings.entry_heights = [&](double pass) {
            // The layer above has cut the same loops.
            return heights_over(std::max(above, pass));
        };
        cutter.cut(cleared, settings);
        settings.skip_above = above = heights[layer];
    }
}

}  // namespace

bool is_roughed(const Operation& operation)
{
    return operation.levels.max_depth.has_value() || !operation.levels.layers.empty();
}

bool finish_is_last_layer(const Operation& operation)
{
    return is_roughed(operation) && operation.prismatic && operation.levels.layers.empty() &&
           operation.passes.allowance <= 0.0 &&
           (operation.tools.empty() || operation.tools.front().number == operation.tool.number);
}

double rough_stepover(const Operation& operation)
{
    const Tool& tool = operation.tools.empty() ? operation.tool : operation.tools.front();
    return std::min(rough_step(tool, operation.levels.max_depth.value_or(tool.radius)).across,
                    operation.passes.step_over.value_or(kUnbounded));
}

double layer_depth(const Operation& operation)
{
    if (operation.levels.max_depth) {
        return *operation.levels.max_depth;
    }
    double above = 0.0;
    double deepest = 0.0;
    for (const double below : operation.levels.layers) {
        deepest = std::max(deepest, below - above);
        above = below;
    }
    return deepest;
}

double lowest_tip(const ClearedRegion& cleared, const DropCutter& floor)
{
    double lowest = kUnbounded;
    for (const ClearingPass& pass : cleared.passes) {
        for (const Edge& edge : pass.path) {
            const int n = 1 + static_cast<int>(length(edge) / floor.tool().radius);
            for (int i = 0; i < n; ++i) {
                const Vec2d p = point_on(edge, static_cast<double>(i) / n);
                lowest = std::min(lowest, floor.tip_height(p));
            }
        }
    }
    return lowest;
}

// Over 60 lines: the steps of one plan, in order, share its settings.
std::optional<RoughResult> plan_rough_layers(const Pocket& pocket, AxialDepthTracker* cut_depth)
{
    const Job& job = pocket.job;
    const Operation& operation = pocket.operation;
    const ToleranceSplit& tolerances = pocket.tolerances;
    if (!is_roughed(operation)) {
        return std::nullopt;
    }
    const auto begin = std::chrono::steady_clock::now();
    Operation rough = operation;
    rough.tool = operation.tools.empty() ? operation.tool : operation.tools.front();
    const Pocket roughed{job, rough, tolerances, pocket.region};
    const double depth = operation.levels.max_depth.value_or(rough.tool.radius);
    const RoughStep step = rough_step(rough.tool, depth);
    DropCutter floor{operation.part.floor, rough.tool, tolerances.accuracy};
    if (!tolerances.one_sided) {
        floor.check_edge_gouges(operation.tolerance.floor);
    }
    ClearingSettings clearing;
    clearing.wall_clearance = tolerances.wall_clearance - operation.tool.radius +
                              rough.tool.radius + operation.passes.allowance;
    clearing.stepover = rough_stepover(operation);
    clearing.direction = operation.passes.direction_of_cut;
    ClearedRegion cleared = clear_region(pocket.region, clearing);
    RoughResult result;
    result.wall_clearance = clearing.wall_clearance;
    result.left = operation.passes.allowance + step.scallop_height;
    set_tool(result.operation.path, job, rough.tool);
    if (cleared.passes.empty()) {
        return result;
    }
    CutSettings settings = rough_settings(roughed, clearing.wall_clearance);
    for (ClearingPass& pass : cleared.passes) {
        pass.path = flattened(pass.path, settings.path_settings.plan_tolerance,
                              settings.path_settings.spacing, settings.path_settings.arcs);
    }
    const double bottom = lowest_tip(cleared, floor) + operation.passes.allowance;
    if (operation.levels.layers.empty() && bottom >= job.stock_top) {
        return result;
    }
    if (operation.passes.max_engagement) {
        fill_adaptively(roughed, bottom, result);
        if (cut_depth != nullptr) {
            cut_depth->begin(rough.tool);
            cut_depth->track(result.operation.path.moves);
        }
        warn_of_thin_layers(pocket, result);
        result.operation.stats.planning_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        return result;
    }
    settings.repeated.assign(cleared.passes.size(), true);
    ClPathWriter moves{job.stock_top + job.clearance};
    const RegionOffset walls{pocket.region};
    PocketPathWriter cutter{rough, floor, walls, moves, cut_depth};
    if (cut_depth != nullptr) {
        cut_depth->begin(rough.tool);
    }
    const int each = cleared.leaves + static_cast<int>(operation.outline.islands.size());
    result.heights =
        layer_heights(pocket, bottom, std::max(0.1 * depth, depth - step.scallop_height));
    if (finish_is_last_layer(operation)) {
        result.heights.pop_back();
        if (result.heights.empty()) {
            return std::nullopt;
        }
    }
    cut_layers(job, cleared, result.heights, each, std::move(settings), cutter);
    cutter.end();
    warn_of_thin_layers(pocket, result);
    fill_operation(operation, cleared, moves, result);
    result.operation.stats.gouge_bound_mm = std::max(0.0, -cutter.least_clearance());
    result.operation.stats.planning_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

}  // namespace cusp::contour_pocket
