// Checks an operation as a whole, strategy by strategy.
#include "host_tools/job/job/operation_check.hpp"

#include <algorithm>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/job/level_floor.hpp"
#include "host_tools/job/job/loop_shape.hpp"

#include "fmt/format.h"

namespace cusp::job {

using toolpath::Tool;

namespace {

void check_islands(const Operation& operation)
{
    constexpr double kChord = 1e-3;
    if (!operation.outline.boundary) {
        return;
    }
    const auto outer = loop_polyline(*operation.outline.boundary, kChord);
    for (std::size_t i = 0; i < operation.outline.islands.size(); ++i) {
        const auto island = loop_polyline(operation.outline.islands[i], kChord);
        if (lies_outside(island, outer)) {
            throw InputError(
                fmt::format("{}: the island lies outside the boundary {} at ({:g}, {:g}) mm",
                            operation.outline.island_files[i], operation.outline.boundary_file,
                            island[0].x, island[0].y));
        }
    }
}

// For contour_pocket: keys that only roughing uses are refused where nothing is roughed.
void check_roughing(const Operation& operation, const Refuse& refuse)
{
    const std::vector<Tool>& tools = operation.tools;
    if (tools.size() > 2 || (tools.size() == 2 && tools[1].number != operation.tool.number)) {
        refuse("tools", fmt::format("the first may rough, tool {} finishes; others are not used",
                                    operation.tool.number));
    }
    if (operation.levels.max_depth || !operation.levels.layers.empty()) {
        return;
    }
    const std::string why = "needs max_depth or layers: without them nothing is roughed";
    if (operation.passes.allowance > 0) {
        refuse("allowance", why);
    }
    if (tools.front().number != operation.tool.number) {
        refuse("tools", fmt::format("tool {} {}", tools.front().number, why));
    }
}

// Keys that adaptive clearing of pockets does not know are refused. Over a level floor it cuts to size;
// over others it roughs.
void check_adaptive(const Operation& operation, const Refuse& refuse)
{
    if (!operation.passes.max_engagement) {
        return;
    }
    if (!operation.prismatic && !level_floor(operation)) {
        if (!operation.levels.max_depth && operation.levels.layers.empty()) {
            refuse("clearing",
                   "\"adaptive\" needs max_depth or layers: the floor is not level, so passes of "
                   "bounded engagement rough it");
        }
        return;
    }
    if (operation.tool.shape != toolpath::ToolShape::kFlat) {
        refuse("clearing", fmt::format("\"adaptive\" needs a flat end; tool {} is {}",
                                       operation.tool.number, name_of(operation.tool.shape)));
    }
    if (operation.tools.size() > 1 || operation.tools.front().number != operation.tool.number) {
        refuse("tools",
               "has more than the operation's tool: clearing = \"adaptive\" cuts "
               "with one; a second operation may finish");
    }
    if (operation.passes.allowance > 0) {
        refuse("allowance", "does not go with clearing = \"adaptive\", which cuts to size");
    }
    if (operation.levels.min_depth) {
        refuse("min_depth", "does not go with clearing = \"adaptive\"");
    }
}

}  // namespace

void need(
    bool there, const char* key, const char* what, const Operation& operation, const Refuse& refuse)
{
    if (!there) {
        refuse(key, fmt::format("is missing: {} needs {}", operation.name(), what));
    }
}

double flank_height(const Tool& tool)
{
    const double slope = 1 / elementary::tan(tool.tip_angle / 2);
    return (tool.radius - tool.tip_radius) * slope;
}

void check_sideways(const Operation& operation, const Refuse& refuse)
{
    const Tool& tool = operation.tool;
    if (tool.shape == toolpath::ToolShape::kDrill) {
        refuse("tool", fmt::format("tool {} is a drill: it cuts straight down only, {} moves "
                                   "sideways",
                                   tool.number, operation.name()));
    }
}

void check_level(const Operation& operation, const Refuse& refuse)
{
    const Tool& tool = operation.tool;
    need(operation.prismatic->given_depth, "depth", "how deep it cuts", operation, refuse);
    check_sideways(operation, refuse);
    if (is_conical(tool)) {
        refuse("tool", fmt::format("tool {} is {}: {} needs vertical flanks: a flat, bull or "
                                   "ball end",
                                   tool.number, name_of(tool.shape), operation.name()));
    }
}

void check_end(const Operation& operation, const Refuse& refuse)
{
    if (is_conical(operation.tool)) {
        refuse("tool",
               fmt::format("tool {} is {}: {} needs a ball, flat or bull end",
                           operation.tool.number, name_of(operation.tool.shape), operation.name()));
    }
}

void check_finishing_end(const Operation& operation, const Refuse& refuse)
{
    const auto is_taper = [](const Tool& tool) {
        return tool.shape == toolpath::ToolShape::kTaper;
    };
    if (!is_taper(operation.tool)) {
        check_end(operation, refuse);
    }
    if (operation.passes.roughing &&
        std::any_of(operation.tools.begin(), operation.tools.end(), is_taper)) {
        refuse("tools", "has a taper, which does not rough: name a flat, bull or ball end");
    }
}

void check_least_depth(const Operation& operation, const Refuse& refuse)
{
    if (!operation.levels.min_depth) {
        return;
    }
    if (!operation.levels.max_depth && operation.levels.layers.empty()) {
        refuse("min_depth",
               "needs max_depth or layers: without them " + operation.name() + " cuts no layers");
    }
    constexpr double kRounding = 1e-6;  // mm
    double above = 0;
    for (const double depth : operation.levels.layers) {
        if (depth - above < *operation.levels.min_depth - kRounding) {
            refuse("layers", fmt::format("the layer down to {:g} mm is {:g} mm deep, less "
                                         "than the min_depth of {:g} mm",
                                         depth, depth - above, *operation.levels.min_depth));
        }
        above = depth;
    }
}

void check_pocket(const Operation& operation, const Refuse& refuse)
{
    check_end(operation, refuse);
    need(operation.outline.boundary.has_value(), "boundary", "the loop that bounds the pocket",
         operation, refuse);
    need(operation.tolerance.scallop.has_value(), "scallop",
         "the height of the scallops that may remain", operation, refuse);
    check_least_depth(operation, refuse);
    check_roughing(operation, refuse);
    check_adaptive(operation, refuse);
}

void check_adaptive_roughing(const Operation& operation, const Refuse& refuse)
{
    if (operation.passes.max_engagement && !operation.passes.roughing) {
        refuse("clearing", "\"adaptive\" needs roughing = true: without it nothing is roughed");
    }
}

void check_operation(const Strategy& strategy, const Operation& operation, const Refuse& refuse)
{
    if (strategy.check != nullptr) {
        strategy.check(operation, refuse);
    }
    check_islands(operation);
}

}  // namespace cusp::job
