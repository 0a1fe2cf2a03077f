// Checks an operation as a whole, strategy by strategy.
#include "host_tools/job/import/operation_check.hpp"

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/job/loop_shape.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::lies_outside;
using job::loop_polyline;
using job::Operation;
using toolpath::Tool;

namespace {

void check_islands(const Operation& operation)
{
    constexpr double kChord = 1e-3;
    if (!operation.boundary) {
        return;
    }
    const auto outer = loop_polyline(*operation.boundary, kChord);
    for (std::size_t i = 0; i < operation.islands.size(); ++i) {
        const auto island = loop_polyline(operation.islands[i], kChord);
        if (lies_outside(island, outer)) {
            throw InputError(fmt::format(
                "{}: the island lies outside the boundary {} at ({:g}, {:g}) mm",
                operation.island_files[i], operation.boundary_file, island[0].x, island[0].y));
        }
    }
}

// For strategies that always finish: min_depth has no effect without layers.
void check_least_depth(const JobTable& table, const Operation& operation)
{
    if (!operation.min_depth) {
        return;
    }
    if (!operation.max_depth && operation.layers.empty()) {
        table.refuse("min_depth", "needs max_depth or layers: without them " + operation.strategy +
                                      " cuts no layers");
    }
    constexpr double kRounding = 1e-6;  // mm
    double above = 0;
    for (const double depth : operation.layers) {
        if (depth - above < *operation.min_depth - kRounding) {
            table.refuse("layers", fmt::format("the layer down to {:g} mm is {:g} mm deep, less "
                                               "than the min_depth of {:g} mm",
                                               depth, depth - above, *operation.min_depth));
        }
        above = depth;
    }
}

// For contour_pocket: keys that only roughing uses are refused where nothing is roughed.
void check_roughing(const JobTable& table, const Operation& operation)
{
    const std::vector<Tool>& tools = operation.tools;
    if (tools.size() > 2 || (tools.size() == 2 && tools[1].number != operation.tool.number)) {
        table.refuse("tools",
                     fmt::format("the first may rough, tool {} finishes; others are not used",
                                 operation.tool.number));
    }
    if (operation.max_depth || !operation.layers.empty()) {
        return;
    }
    const std::string why = "needs max_depth or layers: without them nothing is roughed";
    if (operation.allowance > 0) {
        table.refuse("allowance", why);
    }
    if (tools.front().number != operation.tool.number) {
        table.refuse("tools", fmt::format("tool {} {}", tools.front().number, why));
    }
}

// Adaptive clearing has no lines that could overlap, and clears something only where there is roughing.
void check_adaptive_levels(const JobTable& table, const Operation& operation)
{
    if (!operation.max_engagement) {
        return;
    }
    if (operation.overlap > 0) {
        table.refuse("overlap", "does not go with clearing = \"adaptive\", which has no lines");
    }
    if (operation.strategy == "grid_pocket") {
        if (!operation.max_depth && operation.layers.empty()) {
            table.refuse("clearing",
                         "\"adaptive\" needs max_depth or layers: without them nothing "
                         "is roughed");
        }
        return;
    }
    if (operation.strategy != "hull_rough" && !operation.roughing) {
        table.refuse("clearing",
                     "\"adaptive\" needs roughing = true: without it nothing is roughed");
    }
}

// Keys that adaptive clearing of pockets does not know are refused.
void check_adaptive(const JobTable& table, const Operation& operation)
{
    if (!operation.max_engagement) {
        return;
    }
    if (operation.tool.shape != toolpath::ToolShape::kFlat) {
        table.refuse("clearing", fmt::format("\"adaptive\" needs a flat end; tool {} is {}",
                                             operation.tool.number, name_of(operation.tool.shape)));
    }
    if (operation.tools.size() > 1 || operation.tools.front().number != operation.tool.number) {
        table.refuse("tools",
                     "has more than the operation's tool: clearing = \"adaptive\" cuts "
                     "with one; a second operation may finish");
    }
    if (operation.allowance > 0) {
        table.refuse("allowance", "does not go with clearing = \"adaptive\", which cuts to size");
    }
    if (operation.min_depth) {
        table.refuse("min_depth", "does not go with clearing = \"adaptive\"");
    }
}

void check_strategy(const JobTable& table, const Operation& operation)
{
    const std::string& strategy = operation.strategy;
    const auto need = [&](bool there, const char* key, const char* what) {
        if (!there) {
            table.refuse(key, fmt::format("is missing: {} needs {}", strategy, what));
        }
    };
    if (is_conical(operation.tool)) {
        table.refuse("tool",
                     fmt::format("tool {} is {}: {} needs a ball, flat or bull end",
                                 operation.tool.number, name_of(operation.tool.shape), strategy));
    }
    if (strategy == "contour_pocket" || strategy == "pocket") {
        need(operation.boundary.has_value(), "boundary", "the loop that bounds the pocket");
        need(operation.scallop.has_value(), "scallop",
             "the height of the scallops that may remain");
        check_least_depth(table, operation);
        check_roughing(table, operation);
        check_adaptive(table, operation);
    } else if (strategy == "grid_pocket") {
        need(operation.boundary.has_value(), "boundary", "the loop that bounds the pocket");
        need(operation.grid_x > 0, "grid", "the size of its cells, [gx, gy]");
        check_least_depth(table, operation);
    } else if (strategy == "hull_rough") {
        need(operation.max_depth.has_value(), "max_depth", "the depth of cut of a layer");
    } else if (strategy == "parallel_planes") {
        need(operation.step_over || operation.scallop, "step_over", "it or scallop");
    } else {
        need(operation.iso_distance || operation.scallop, "iso_distance", "it or scallop");
    }
    if (strategy != "contour_pocket" && strategy != "pocket") {
        check_adaptive_levels(table, operation);
    }
}

}  // namespace

void check_operation(const JobTable& table, const Operation& operation)
{
    check_strategy(table, operation);
    check_islands(operation);
}

}  // namespace cusp::import
