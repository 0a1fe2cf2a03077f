// Error messages name the file, the quantity, its value and its limit.
#include "host_tools/cam/contour_pocket/pocket_task.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host_tools/cam/cl_path/cl_path.hpp"
#include "host_tools/cam/cl_path/nurbs_fit.hpp"
#include "host_tools/geometry/drop_cutter/floor_coverage.hpp"
#include "host_tools/geometry/offset/contour_fit.hpp"
#include "host_tools/geometry/offset/region_check.hpp"

namespace cusp::contour_pocket {

using cl_path::kWrittenStep;
using cl_path::nurbs_fit_available;
using drop_cutter::DropCutter;
using job::CutLevels;
using job::Job;
using job::Loop;
using job::Operation;
using job::OutputForm;
using job::ToleranceSide;
using nurbs::Surface;
using offset::area;
using offset::Contour;
using offset::fit_contour;
using offset::Region2d;
using offset::RegionFault;
using offset::reversed;
using toolpath::OperationStats;
using toolpath::Tool;

namespace {

// Fraction of the finishing tool's radius: a larger tolerance is meaningless for a pocket.
constexpr double kMostTolerance = 0.25;
// In radii of the finishing tool. Larger lengths mean wrong units, or the wrong tool.
constexpr double kMostDepth = 1e3;
constexpr double kMaxPassLength = 1e7;
constexpr int kMostLayers = 1000;

std::string place_text(Vec2d p) { return "(" + number_text(p.x) + ", " + number_text(p.y) + ")"; }

// share  largest value, as a share of the finishing tool's radius
void check_range(
    const Job& job, const Operation& operation, const char* key, double value, double share)
{
    const Tool& tool = operation.tool;
    const double limit = share * tool.radius;
    if (!(value > 0.0) || value > limit) {
        throw InputError(operation_text(job, operation) + key + " " + number_text(value) +
                         " mm is not in the range above 0 to " + number_text(limit) + " mm, " +
                         number_text(share) + " of the radius of tool " + number_text(tool.number));
    }
}

[[noreturn]] void refuse_region(const Operation& operation, const RegionFault& fault)
{
    const auto file = [&](std::size_t contour) {
        return contour == 0 ? operation.outline.boundary_file
                            : operation.outline.island_files.at(contour - 1);
    };
    throw InputError(
        fault_text(fault, file(fault.first), file(fault.second), place_text(fault.where) + " mm"));
}

}  // namespace

std::string operation_text(const Job& job, const Operation& operation)
{
    return job.file + ": operation " + std::to_string(operation.number) + ": contour_pocket: ";
}

std::string no_room_text(const Operation& operation)
{
    return operation.outline.boundary_file + ": operation " + std::to_string(operation.number) +
           ": tool " + std::to_string(operation.tool.number) + " of " +
           number_text(2 * operation.tool.radius) + " mm fits nowhere into the pocket";
}

std::string number_text(double value)
{
    char text[40];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

void report_plunges(int plunges, OperationStats& stats)
{
    if (plunges > 0) {
        stats.warnings.push_back(number_text(plunges) +
                                 " entries had no room for a slope and plunge");
    }
}

ToleranceSplit split_tolerances(const Job& job, const Operation& operation)
{
    const double radius = operation.tool.radius;
    if (operation.part.floor.empty()) {
        throw InputError(operation_text(job, operation) + "floor is missing");
    }
    if (!operation.outline.boundary) {
        throw InputError(operation_text(job, operation) + "boundary is missing");
    }
    if (!operation.tolerance.scallop) {
        throw InputError(operation_text(job, operation) + "scallop is missing");
    }
    if (operation.output == OutputForm::kNurbs && !nurbs_fit_available()) {
        throw InputError(operation_text(job, operation) +
                         "output \"nurbs\" needs Eigen, and this build has none "
                         "(libeigen3-dev, CUSP_EIGEN)");
    }
    check_range(job, operation, "plan_tolerance", operation.tolerance.plan, kMostTolerance);
    check_range(job, operation, "floor_tolerance", operation.tolerance.floor, kMostTolerance);
    check_range(job, operation, "scallop", *operation.tolerance.scallop, 0.9);
    if (operation.passes.allowance != 0.0) {
        check_range(job, operation, "allowance", operation.passes.allowance, 1.0);
    }
    ToleranceSplit tolerances;
    tolerances.one_sided = operation.tolerance.side == ToleranceSide::kOutside;
    tolerances.fit = 0.1 * operation.tolerance.plan;
    tolerances.accuracy = std::min(0.1 * operation.tolerance.floor, 5e-3);
    tolerances.height_tolerance = operation.tolerance.floor - 2.0 * tolerances.accuracy;
    // The plan tolerance allows passes to be closer or farther apart than planned.
    tolerances.scallop_height = *operation.tolerance.scallop - operation.tolerance.floor;
    if (tolerances.one_sided) {
        if (tolerances.scallop_height <= 0.0) {
            throw InputError(operation_text(job, operation) + "scallop " +
                             number_text(*operation.tolerance.scallop) +
                             " mm is not above floor_tolerance " +
                             number_text(operation.tolerance.floor) +
                             " mm, which it includes with tolerance_side \"outside\"");
        }
        tolerances.plan_tolerance =
            0.5 * (operation.tolerance.plan - tolerances.fit) - kWrittenStep;
        tolerances.wall_clearance =
            radius + tolerances.fit + tolerances.plan_tolerance + 2.0 * kWrittenStep;
    } else {
        tolerances.scallop_height = tolerances.scallop_height > 0.0 ? tolerances.scallop_height
                                                                    : *operation.tolerance.scallop;
        tolerances.plan_tolerance = operation.tolerance.plan - tolerances.fit;
        tolerances.wall_clearance = radius;
    }
    tolerances.plan_tolerance = std::max(tolerances.plan_tolerance, kWrittenStep);
    return tolerances;
}

RoughAndFinish split_between_rough_and_finish(const Pocket& pocket)
{
    const Operation& operation = pocket.operation;
    const ToleranceSplit& tolerances = pocket.tolerances;
    constexpr double kNear = 0.2;  // of the room: with less, fits of curves need more moves
    const bool roughs = operation.levels.max_depth || !operation.levels.layers.empty();
    const double near = std::max(kNear * tolerances.plan_tolerance, kWrittenStep);
    const double apart = 2.0 * kWrittenStep;  // ends are rounded to whole steps
    const double rest = tolerances.plan_tolerance - near - apart;
    RoughAndFinish shared{pocket, pocket};
    if (!roughs || operation.passes.allowance > 0.0 || rest < near) {
        return shared;
    }
    shared.rough.tolerances.wall_clearance =
        tolerances.wall_clearance - tolerances.plan_tolerance + near;
    shared.rough.tolerances.plan_tolerance = near;
    shared.finish.tolerances.wall_clearance =
        tolerances.wall_clearance + tolerances.plan_tolerance - rest;
    shared.finish.tolerances.plan_tolerance = rest;
    return shared;
}

Region2d make_region(const Operation& operation, double tolerance)
{
    Region2d region;
    const auto add = [&](const Loop& loop, bool outer) {
        Contour contour = fit_contour(loop, tolerance);
        const bool counter_clockwise = area(contour) > 0.0;
        region.contours.push_back(counter_clockwise == outer ? contour : reversed(contour));
    };
    add(*operation.outline.boundary, true);
    for (const Loop& island : operation.outline.islands) {
        add(island, false);
    }
    if (const auto fault = find_fault(region)) {
        refuse_region(operation, *fault);
    }
    return region;
}

void check_work(const Pocket& pocket)
{
    const Operation& operation = pocket.operation;
    const Tool& tool = operation.tool;
    const double top = pocket.job.stock_top;
    double lowest = top;
    for (const Surface& surface : operation.part.floor) {
        for (const Vec3d p : surface.points) {
            lowest = std::min(lowest, p.z);
        }
    }
    const std::string radius = number_text(tool.radius) + " mm";
    if (top - lowest > kMostDepth * tool.radius) {
        const std::string file =
            operation.part.floor_files.empty() ? "floor" : operation.part.floor_files.front();
        throw InputError(file + ": the floor lies " + number_text(top - lowest) +
                         " mm below stock.top, the limit is " +
                         number_text(kMostDepth * tool.radius) + " mm for the tool of radius " +
                         radius);
    }
    double room = 0.0;
    for (const Contour& contour : pocket.region.contours) {
        room += area(contour);
    }
    const double round = 2.0 * tool.corner_radius;
    const double scallop = pocket.tolerances.scallop_height;
    const double across = 2.0 * (tool.radius - tool.corner_radius) +
                          2.0 * std::sqrt(std::max(0.0, scallop * (round - scallop)));
    const double way = room / std::min(across, 2.0 * tool.radius);
    if (way > kMaxPassLength * tool.radius) {
        throw InputError(operation.outline.boundary_file + ": the pocket of " + number_text(room) +
                         " mm^2 takes " + number_text(way) + " mm of passes, the limit is " +
                         number_text(kMaxPassLength * tool.radius) + " mm for the tool of radius " +
                         radius);
    }
}

int layer_count(const Pocket& pocket, double whole_depth, double max_depth)
{
    const CutLevels& levels = pocket.operation.levels;
    const double count = std::ceil(whole_depth / max_depth - 1e-9);
    if (count > kMostLayers) {
        const std::string key = levels.max_depth ? "max_depth " : "layers of ";
        throw InputError(operation_text(pocket.job, pocket.operation) + key +
                         number_text(levels.max_depth.value_or(max_depth)) + " mm makes " +
                         number_text(count) + " layers of " + number_text(whole_depth) +
                         " mm, the limit is " + number_text(kMostLayers));
    }
    return std::max(1, static_cast<int>(count));
}

void check_coverage(const Operation& operation, const Region2d& region, const DropCutter& floor)
{
    if (const auto place =
            point_without_floor(region, floor, operation.part.floor, operation.tool.radius)) {
        refuse_uncovered(operation, *place);
    }
}

void refuse_uncovered(const Operation& operation, Vec2d p)
{
    const std::string file =
        operation.part.floor_files.empty() ? "floor" : operation.part.floor_files.front();
    throw InputError(file + ": the floor does not cover the pocket at " + place_text(p) + " mm");
}

}  // namespace cusp::contour_pocket
