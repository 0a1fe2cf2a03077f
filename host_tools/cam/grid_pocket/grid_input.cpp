// Error messages name the key, the value and the limit in the units of the job.
#include "host_tools/cam/grid_pocket/grid_input.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "firmware/base/inch.hpp"
#include "host_tools/cam/grid_pocket/grid_pocket.hpp"
#include "host_tools/geometry/drop_cutter/floor_coverage.hpp"
#include "host_tools/geometry/offset/contour_fit.hpp"
#include "host_tools/geometry/offset/region_check.hpp"
#include "host_tools/geometry/toolpath/post.hpp"

namespace cusp::grid_pocket {

using drop_cutter::DropCutter;
using job::Job;
using job::Loop;
using job::Operation;
using job::OutputForm;
using nurbs::Curve;
using offset::area;
using offset::Contour;
using offset::fit_contour;
using offset::Region2d;
using offset::RegionFault;
using offset::reversed;
using toolpath::Tool;

namespace {

// Memory and time grow with the cells: more than this is probably a typing error.
constexpr double kMostCells = 4e6;

bool has_free_curve(const Loop& loop)
{
    return std::any_of(loop.begin(), loop.end(), [](const Curve& c) { return c.degree > 1; });
}

std::string count_text(double count)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.10g", std::floor(count));
    return text;
}

std::string fault_text(const Job& job, const Operation& operation, const RegionFault& fault)
{
    const auto name = [&](std::size_t contour) {
        const auto& islands = operation.outline.island_files;
        if (contour == 0) {
            return operation.outline.boundary_file.empty() ? std::string("boundary")
                                                           : operation.outline.boundary_file;
        }
        return contour <= islands.size() ? islands[contour - 1]
                                         : "island " + std::to_string(contour);
    };
    return offset::fault_text(
        fault, name(fault.first), name(fault.second),
        "x " + length_text(job, fault.where.x) + ", y " + length_text(job, fault.where.y));
}

}  // namespace

void refuse_grid_pocket(const Job& job, const std::string& what)
{
    throw InputError(job.file + ": grid_pocket: " + what);
}

std::string length_text(const Job& job, double mm)
{
    char text[64];
    const double value = job.inch ? mm / kMillimetresPerInch : mm;
    const bool tiny = value != 0 && std::abs(value) < 1e-4;
    std::snprintf(text, sizeof text, tiny ? "%.3g" : job.inch ? "%.6f" : "%.5f", value);
    return std::string{text} + (job.inch ? " in" : " mm");
}

void check_grid_input(const Job& job, const Operation& operation)
{
    const Tool& tool = operation.tool;
    if (operation.part.floor.empty()) {
        refuse_grid_pocket(job, "floor names no surface");
    }
    if (!operation.outline.boundary || operation.outline.boundary->empty()) {
        refuse_grid_pocket(job, "boundary is missing");
    }
    if (!(tool.radius > 0)) {
        refuse_grid_pocket(job, "tool " + std::to_string(tool.number) + " has radius " +
                                    length_text(job, tool.radius) + "; it must be above 0");
    }
    if (operation.output == OutputForm::kNurbs) {
        refuse_grid_pocket(job, "output \"nurbs\": the paper's moves are lines or arcs");
    }
    const double most = 2 * tool.radius / std::sqrt(2.0);
    for (const double size : {grid_keys(operation).grid_x, grid_keys(operation).grid_y}) {
        if (!(size > 0)) {
            refuse_grid_pocket(job, "grid " + length_text(job, size) + " must be above 0");
        }
        // The precision of numbers in a job file.
        if (size > most * (1 + 1e-4)) {
            refuse_grid_pocket(job, "grid " + length_text(job, size) +
                                        " is over the diameter / sqrt 2, " +
                                        length_text(job, most));
        }
    }
    for (const double tolerance :
         {operation.tolerance.floor, operation.tolerance.plan, grid_keys(operation).arc_tolerance,
          grid_keys(operation).max_arc_radius, operation.passes.allowance}) {
        if (!(tolerance >= 0) || !std::isfinite(tolerance)) {
            refuse_grid_pocket(
                job, "tolerance or radius " + length_text(job, tolerance) + " must be at least 0");
        }
    }
    if (operation.levels.max_depth && !(*operation.levels.max_depth > 0)) {
        refuse_grid_pocket(
            job, "max_depth " + length_text(job, *operation.levels.max_depth) + " must be above 0");
    }
    if (grid_keys(operation).max_roughness && !(*grid_keys(operation).max_roughness > 0)) {
        refuse_grid_pocket(job, "max_roughness " +
                                    length_text(job, *grid_keys(operation).max_roughness) +
                                    " must be above 0");
    }
    double before = 0;
    for (const double depth : operation.levels.layers) {
        if (!(depth > before)) {
            refuse_grid_pocket(job, "layers: depth " + length_text(job, depth) +
                                        " is not below the one before, " +
                                        length_text(job, before));
        }
        before = depth;
    }
}

PocketWalls pocket_walls(const Job& job, const Operation& operation)
{
    PocketWalls walls;
    const double tolerance = std::max(operation.tolerance.plan / 2, 1e-4);
    const auto add = [&](const Loop& loop) {
        walls.region.contours.push_back(fit_contour(loop, tolerance));
        walls.wall_error = std::max(walls.wall_error, has_free_curve(loop) ? tolerance : 0.0);
        const bool outer = walls.region.contours.size() == 1;
        Contour& contour = walls.region.contours.back();
        if ((area(contour) > 0) != outer) {
            contour = reversed(contour);
        }
    };
    add(*operation.outline.boundary);
    for (const Loop& island : operation.outline.islands) {
        add(island);
    }
    if (const auto fault = find_fault(walls.region)) {
        refuse_grid_pocket(job, fault_text(job, operation, *fault));
    }
    const double cells = std::abs(area(walls.region.contours[0])) / grid_keys(operation).grid_x /
                         grid_keys(operation).grid_y;
    if (cells > kMostCells) {
        refuse_grid_pocket(job, "grid " + length_text(job, grid_keys(operation).grid_x) + " x " +
                                    length_text(job, grid_keys(operation).grid_y) + " makes " +
                                    count_text(cells) + " cells; at most " +
                                    count_text(kMostCells));
    }
    return walls;
}

void check_grid_floor(const Job& job, const Operation& operation, const Region2d& region)
{
    const DropCutter floor{operation.part.floor, operation.tool, 0.01};
    if (const auto at =
            point_without_floor(region, floor, operation.part.floor, operation.tool.radius)) {
        const std::string file =
            operation.part.floor_files.empty() ? "floor" : operation.part.floor_files.front();
        refuse_grid_pocket(job, file + ": the floor does not cover the pocket at x " +
                                    length_text(job, at->x) + ", y " + length_text(job, at->y));
    }
}

}  // namespace cusp::grid_pocket
