// Checks the input, then roughs with one cutter after another, the largest first.
#include "host_tools/cam/adaptive_isocurve/waterline_roughing.hpp"

#include <algorithm>
#include <utility>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/adaptive_isocurve/rough_constants.hpp"
#include "host_tools/cam/adaptive_isocurve/waterline_rougher.hpp"
#include "host_tools/cam/finishing/surface_operation.hpp"

#include "fmt/format.h"

namespace cusp::adaptive_isocurve {

using finishing::check_clearance;
using job::Job;
using job::kRoughingDone;
using job::Operation;
using part_model::PartModel;
using toolpath::PlannedOperation;
using toolpath::Tool;

namespace {

RoughStock stock_of(const Job& job, const PartModel& model, double allowance)
{
    const Vec3d low = model.box_low();
    const Vec3d high = model.box_high();
    RoughStock stock{
        {low.x, low.y, high.x, high.y}, std::max(job.stock_top, high.z), low.z + allowance};
    if (job.stock_x) {
        stock.plan.x0 = std::min(stock.plan.x0, (*job.stock_x)[0]);
        stock.plan.x1 = std::max(stock.plan.x1, (*job.stock_x)[1]);
    }
    if (job.stock_y) {
        stock.plan.y0 = std::min(stock.plan.y0, (*job.stock_y)[0]);
        stock.plan.y1 = std::max(stock.plan.y1, (*job.stock_y)[1]);
    }
    if (job.stock_bottom) {
        stock.bottom = std::max(stock.bottom, *job.stock_bottom);
    }
    return stock;
}

// The cutters in order: the largest first, among equal radii the one with the flattest end.
std::vector<Tool> cutters_of(const Operation& operation)
{
    std::vector<Tool> tools = operation.tools;
    if (tools.empty()) {
        tools.push_back(operation.tool);
    }
    std::stable_sort(tools.begin(), tools.end(), [](const Tool& a, const Tool& b) {
        return a.radius > b.radius || (a.radius == b.radius && a.corner_radius < b.corner_radius);
    });
    return tools;
}

void check(const Job& job, const Operation& operation, const std::vector<Tool>& tools)
{
    for (const Tool& tool : tools) {
        if (!(operation.tolerance.plan < tool.radius)) {
            throw InputError(fmt::format(
                "{}: {} with roughing = true: plan_tolerance is {:g} mm, not below the radius of "
                "{:g} mm of tool {}",
                job.file, operation.name(), operation.tolerance.plan, tool.radius, tool.number));
        }
    }
}

std::vector<PlannedOperation> nothing_roughed(const std::string& why)
{
    PlannedOperation none;
    none.stats.warnings = {"nothing is roughed: " + why};
    return {std::move(none)};
}

}  // namespace

std::vector<PlannedOperation> plan_waterline_roughing(const Job& job,
                                                      const Operation& operation,
                                                      const LevelFloors& floors)
{
    const std::vector<Tool> tools = cutters_of(operation);
    check(job, operation, tools);
    const PartModel model = operation.part.mesh.empty() ? PartModel{operation.part.floor}
                                                        : PartModel{operation.part.mesh};
    check_clearance(job, operation, model);
    const RoughStock stock = stock_of(job, model, operation.passes.allowance);
    const double share = kRoughingDone / static_cast<double>(tools.size());
    RoughWork work{job,
                   operation,
                   model,
                   stock,
                   rough_depths(job, operation, tools, stock.top, stock.bottom),
                   floors,
                   0.0,
                   0.0,
                   share};
    if (work.depths.heights.empty()) {
        return nothing_roughed(fmt::format(
            "with an allowance of {:g} mm the lowest level is at z = {:.6g} mm, the stock's top at "
            "{:.6g} mm",
            operation.passes.allowance, stock.bottom, stock.top));
    }
    std::vector<PlannedOperation> out;
    std::vector<RoughedWaterlines> before;
    std::vector<std::string> warnings;
    double keep = operation.passes.allowance + kRounded;
    for (const Tool& tool : tools) {
        // A coarser lattice is sufficient if a smaller tool follows.
        work.least_pitch = std::max(tools.back().radius, 0.5 * tool.radius) / kPitchOfRadius;
        RoughedTool roughed = rough_with(work, tool, keep, before);
        work.share_before += share;
        if (roughed.loops == 0) {
            warnings.push_back(
                fmt::format("tool {} fits nowhere into the stock that is left", tool.number));
            continue;
        }
        keep = roughed.keeps;
        before.push_back(std::move(roughed.levels));
        out.push_back(std::move(roughed.planned));
    }
    if (out.empty()) {
        return nothing_roughed(
            fmt::format("no roughing tool fits into the stock with an allowance of {:g} mm",
                        operation.passes.allowance));
    }
    const double least = operation.levels.min_depth.value_or(0);
    if (work.depths.thinnest < least - kRounded) {
        warnings.push_back(fmt::format(
            "levels are {:.3f} mm deep, less than min_depth, {:g} mm: max_depth and the height of "
            "the stock, {:g} mm, allow no deeper ones",
            work.depths.thinnest, least, stock.top - stock.bottom));
    }
    std::vector<std::string>& reported = out.front().stats.warnings;
    reported.insert(reported.end(), warnings.begin(), warnings.end());
    return out;
}

}  // namespace cusp::adaptive_isocurve
