// Checks the input, plans layers, and clears every layer with every cutter.
#include "host_tools/cam/hull_rough/hull_rough.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "firmware/base/inch.hpp"
#include "firmware/base/math.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/hull_rough/roughing.hpp"

namespace cusp::hull_rough {

using job::Job;
using job::Operation;
using job::OutputForm;
using job::Traversal;
using nurbs::Surface;
using toolpath::PlannedOperation;
using toolpath::Tool;
using toolpath::ToolShape;

namespace {

// Time of a manual tool change on a small mill, for the choice of cutters.
constexpr double kChangeSeconds = 60.0;

constexpr int kMostSubdivisions = 8;

// Lines exactly a diameter apart would leave fins of no width through all layers: they overlap by
// at least this share of the diameter.
constexpr double kLeastOverlap = 0.01;

[[noreturn]] void refuse(const Job& job, const std::string& what)
{
    throw InputError(job.file + ": hull_rough: " + what);
}

void check(const Job& job, const Operation& operation, const std::vector<Tool>& tools)
{
    if (operation.part.floor.empty()) {
        refuse(job, "floor names no surface");
    }
    if (operation.outline.boundary || !operation.outline.islands.empty()) {
        refuse(job,
               "boundary and islands are not used by this strategy: the stock is the boundary");
    }
    if (operation.output == OutputForm::kNurbs) {
        refuse(job, "output \"nurbs\": layers are lines or arcs");
    }
    if (hull_keys(operation).extra_subdivision < 0 ||
        hull_keys(operation).extra_subdivision > kMostSubdivisions) {
        refuse(job, "extra_subdivision " + std::to_string(hull_keys(operation).extra_subdivision) +
                        " lies outside 0 to " + std::to_string(kMostSubdivisions));
    }
    for (const double size : {operation.passes.allowance, operation.tolerance.plan}) {
        if (!(size >= 0) || !std::isfinite(size)) {
            refuse(job, "allowance or tolerance " + plain_number(size) + " mm must be at least 0");
        }
    }
    for (const Tool& tool : tools) {
        if (!(tool.radius > 0)) {
            refuse(job, "tool " + std::to_string(tool.number) + " has radius " +
                            plain_number(tool.radius) + " mm; it must be above 0");
        }
        if (!(hull_keys(operation).overlap >= 0 &&
              hull_keys(operation).overlap < 2 * tool.radius)) {
            refuse(job, "overlap " + plain_number(hull_keys(operation).overlap) +
                            " mm lies outside 0 to the diameter " + plain_number(2 * tool.radius) +
                            " mm of tool " + std::to_string(tool.number));
        }
    }
}

DepthLimits depth_limits(const Job& job, const Operation& operation, const Tool& tool)
{
    const double most = operation.levels.max_depth.value_or(tool.radius);
    const double least = operation.levels.min_depth.value_or(most / 2);
    if (!(most > 0) || !std::isfinite(most)) {
        refuse(job, "max_depth " + plain_number(most) + " mm must be above 0");
    }
    if (!(least >= 0 && least <= most)) {
        refuse(job, "min_depth " + plain_number(least) + " mm lies outside 0 to max_depth " +
                        plain_number(most) + " mm");
    }
    return {most, least};
}

// The width that the cutter clears to a scallop of this height; less than its diameter for a tool
// with a corner radius.
double cleared_width(const Tool& tool, double scallop_height)
{
    const double corner = tool.shape == ToolShape::kFlat ? 0.0 : tool.corner_radius;
    const double height = std::min(corner, scallop_height);
    return 2 * (tool.radius - corner + std::sqrt(height * (2 * corner - height)));
}

// The box of all hulls, trimmed parts included, extended to the job's stock and to its top if that
// is higher.
StockBox stock_of(const Job& job, std::vector<Surface> surfaces)
{
    StockBox stock{{kUnbounded, kUnbounded, -kUnbounded, -kUnbounded}, -kUnbounded, kUnbounded};
    for (Surface& surface : surfaces) {
        surface.trims.clear();
    }
    for (const HullPatch& patch : hull_patches(surfaces)) {
        const Rectangle box = plan_box(patch);
        stock.plan = {std::min(stock.plan.x_min, box.x_min), std::min(stock.plan.y_min, box.y_min),
                      std::max(stock.plan.x_max, box.x_max), std::max(stock.plan.y_max, box.y_max)};
        stock.top = std::max(stock.top, patch.top);
        stock.bottom = std::min(stock.bottom, patch.bottom);
    }
    if (job.stock_x) {
        stock.plan.x_min = std::min(stock.plan.x_min, (*job.stock_x)[0]);
        stock.plan.x_max = std::max(stock.plan.x_max, (*job.stock_x)[1]);
    }
    if (job.stock_y) {
        stock.plan.y_min = std::min(stock.plan.y_min, (*job.stock_y)[0]);
        stock.plan.y_max = std::max(stock.plan.y_max, (*job.stock_y)[1]);
    }
    stock.top = std::max(stock.top, job.stock_top);
    if (job.stock_bottom) {
        stock.bottom = std::max(stock.bottom, *job.stock_bottom);
    }
    return stock;
}

LayerPlan planned_layers(const Job& job,
                         const Operation& operation,
                         std::vector<HullPatch> patches,
                         const StockBox& stock,
                         DepthLimits limits)
{
    if ((stock.top - stock.bottom) / limits.max_thickness > 1e4) {
        refuse(job, "max_depth " + plain_number(limits.max_thickness) +
                        " mm makes more than 10000 layers of a stock " +
                        plain_number(stock.top - stock.bottom) + " mm high");
    }
    if (!operation.levels.layers.empty()) {
        LayerPlan plan;
        plan.planes.push_back(stock.top);
        for (const double depth : operation.levels.layers) {
            const double z = job.stock_top - depth;
            if (z >= plan.planes.back() || z < stock.bottom - 1e-9) {
                refuse(job, "layers: depth " + plain_number(depth) +
                                " mm is not below the one before and above " + "the bottom at z " +
                                plain_number(stock.bottom) + " mm");
            }
            plan.planes.push_back(z);
        }
        plan.patches = std::move(patches);
        return plan;
    }
    LayerPlan plan = depth_layers(std::move(patches), stock.top, stock.bottom, limits);
    if (hull_keys(operation).extra_subdivision > 0) {
        plan.planes = least_leftover_planes(plan, limits);
    }
    return plan;
}

// Rounds planes up to the digits of G-code, so that writing does not lower them; and up once more
// where a layer would become thicker than most_depth (mm).
void round_up(LayerPlan& plan, double most_depth, bool inch)
{
    const double digit = inch ? 1e-5 * kMillimetresPerInch : 1e-4;
    constexpr double kSame = 1e-4;  // of a digit
    std::vector<double> planes{plan.planes.front()};
    for (std::size_t i = 1; i < plan.planes.size(); ++i) {
        const bool within = plan.planes[i - 1] - plan.planes[i] <= most_depth + kSame * digit;
        const double least = within ? planes.back() - most_depth : plan.planes[i];
        const double z = std::ceil(std::max(plan.planes[i], least) / digit - kSame) * digit;
        if (z < planes.back()) {
            planes.push_back(z);
        }
    }
    plan.planes = std::move(planes);
}

// Returns false where no tool clears anything in any layer.
bool clear_layers(Roughing& work)
{
    constexpr std::size_t kAtOnce = 4;  // layers
    const Operation& operation = work.operation;
    std::vector<std::vector<Rectangle>> boxes;
    for (std::size_t layer = 0; layer < work.layers(); ++layer) {
        boxes.push_back(boxes_above(work.plan.patches,
                                    work.bottom(layer) - operation.passes.allowance,
                                    hull_keys(operation).extra_subdivision));
        work.boxes += boxes.back().size();
        work.left_under_boxes += work.thickness(layer) * union_area(boxes.back(), work.stock.plan);
    }
    work.clearings.resize(work.layers());
    for (std::size_t first = 0; first < work.layers(); first += kAtOnce) {
        work.job.report_progress(0.9 * static_cast<double>(first) /
                                 static_cast<double>(work.layers()));
        parallel::for_each(std::min(kAtOnce, work.layers() - first), [&](std::size_t k) {
            for (const Tool& tool : work.tools) {
                work.clearings[first + k].push_back(
                    clear_layer(boxes[first + k], work.stock.plan, tool.radius,
                                layer_settings(work, first + k, tool)));
            }
        });
    }
    std::vector<std::vector<ToolOffer>> offers(work.layers());
    double cleared = 0;
    for (std::size_t layer = 0; layer < work.layers(); ++layer) {
        for (std::size_t k = 0; k < work.tools.size(); ++k) {
            const LayerClearing& made = work.clearings[layer][k];
            offers[layer].push_back(
                {made.length / rates_of(work.job, work.tools[k]).feed * 60, made.cleared_area});
            cleared += made.cleared_area;
        }
    }
    constexpr double kNoArea = 1e-6;  // mm^2
    if (cleared < kNoArea) {
        return false;
    }
    work.choice = choose_tools(offers, kChangeSeconds);
    return true;
}

std::vector<PlannedOperation> nothing_roughed(const std::string& why)
{
    PlannedOperation none;
    none.stats.strategy = kHullRough.name;
    none.stats.warnings = {"hull_rough: nothing is roughed: " + why};
    return {std::move(none)};
}

}  // namespace

LayerSettings layer_settings(const Roughing& work, std::size_t layer, const Tool& tool)
{
    const Operation& operation = work.operation;
    LayerSettings settings;
    // The overlap is that of the whole cutter; the width cleared to the scallop is smaller.
    settings.clears = cleared_width(tool, work.scallop_height(layer) - work.rest_height(layer)) / 2;
    settings.step =
        std::min(std::max(2 * tool.radius - hull_keys(operation).overlap, tool.radius / 50),
                 2 * settings.clears * (1 - kLeastOverlap));
    settings.tolerance = std::max(operation.tolerance.plan, kLeastTolerance);
    settings.side_allowance = operation.passes.allowance;
    settings.one_way = operation.passes.traversal == Traversal::kOneWay;
    settings.contour = hull_keys(operation).contour_clearing;
    settings.direction = operation.passes.direction_of_cut;
    if (operation.passes.max_engagement) {
        settings.max_engagement = *operation.passes.max_engagement * kPi / 180;
    }
    return settings;
}

std::vector<PlannedOperation> plan_hull_rough(const Job& job, const Operation& operation)
{
    const auto start = std::chrono::steady_clock::now();
    std::vector<Tool> tools = operation.tools;
    if (tools.empty()) {
        tools.push_back(operation.tool);
    }
    std::sort(tools.begin(), tools.end(),
              [](const Tool& a, const Tool& b) { return a.radius > b.radius; });
    check(job, operation, tools);
    std::vector<HullPatch> patches = hull_patches(operation.part.floor);
    if (patches.empty()) {
        refuse(job, "the trims of the floor leave nothing of it");
    }
    const StockBox stock = stock_of(job, operation.part.floor);
    const DepthLimits limits = depth_limits(job, operation, tools.back());
    constexpr double kNoHeight = 1e-3;  // mm
    if (stock.top - stock.bottom < kNoHeight) {
        return nothing_roughed("the part is flat: its hull is " +
                               plain_number(stock.top - stock.bottom) + " mm high");
    }
    LayerPlan plan = planned_layers(job, operation, std::move(patches), stock, limits);
    round_up(plan, limits.max_thickness, job.inch);
    Roughing work{
        job, operation, std::move(tools), stock, std::move(plan), limits.max_thickness, {}, {},
        0,   0};
    if (!clear_layers(work)) {
        return nothing_roughed(
            "no cutter reaches into the stock in any layer; the smallest has radius " +
            plain_number(work.tools.back().radius) + " mm, with an allowance of " +
            plain_number(operation.passes.allowance) + " mm");
    }
    std::vector<PlannedOperation> out = write_layers(work);
    job.report_progress(1);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    add_report(work, out, spent.count());
    return out;
}

}  // namespace cusp::hull_rough
