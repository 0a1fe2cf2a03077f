// Parallel passes, equally spaced, that begin and end beside the stock.
#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/prismatic/cut_levels.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/job/job/loop_shape.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using job::CutDirection;
using job::Job;
using job::loop_polyline;
using job::NestedLoop;
using job::Operation;
using job::Traversal;
using offset::Box2d;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;

namespace {

constexpr double kStepover = 0.75;  // of the level bottom's diameter
constexpr double kOverhang = 1.0;   // mm

Box2d faced_box(const Job& job, const Operation& operation)
{
    Box2d box;
    for (const NestedLoop& loop : operation.prismatic->loops) {
        for (const Vec2d p : loop_polyline(loop.loop, kOverhang / 100)) {
            box = {std::min(box.x0, p.x), std::min(box.y0, p.y), std::max(box.x1, p.x),
                   std::max(box.y1, p.y)};
        }
    }
    if (operation.prismatic->loops.empty()) {
        if (!job.stock_x || !job.stock_y) {
            throw InputError(operation_text(job, operation) +
                             "what to face is missing: x and y of [stock], or a boundary");
        }
        box = {(*job.stock_x)[0], (*job.stock_y)[0], (*job.stock_x)[1], (*job.stock_y)[1]};
    }
    return box;
}

double stepover_of(const Job& job, const Operation& operation)
{
    const double across = 2 * flat_radius(operation.tool);
    if (!(across > 0)) {
        throw InputError(fmt::format("{}tool {} is a {}: its bottom is not level",
                                     operation_text(job, operation), operation.tool.number,
                                     name_of(operation.tool.shape)));
    }
    const double step = operation.passes.step_over.value_or(kStepover * across);
    if (step > across) {
        throw InputError(
            fmt::format("{}step_over {:g} mm leaves ridges, the bottom of tool {} is "
                        "{:g} mm wide",
                        operation_text(job, operation), step, operation.tool.number, across));
    }
    return step;
}

}  // namespace

std::vector<PlannedOperation> plan_face(const Job& job, const Operation& operation)
{
    constexpr double kMostPasses = 1e5;
    const Box2d box = faced_box(job, operation);
    const double step = stepover_of(job, operation);
    const double passes = std::max(1.0, std::ceil((box.y1 - box.y0) / step - 1e-9));
    if (passes > kMostPasses) {
        throw InputError(fmt::format("{}step_over {:g} mm makes {:g} passes, the limit is {:g}",
                                     operation_text(job, operation), step, passes, kMostPasses));
    }
    const std::vector<double> levels = cut_levels(job, operation, operation.prismatic->depth);
    PlannedOperation planned =
        begun(job, operation,
              fmt::format("to z {:.6g} mm, {} a level", levels.back(),
                          counted(static_cast<std::size_t>(passes), "pass", "passes")));
    ToolpathWriter writer{planned.path.moves, {job.stock_top + job.clearance}};
    const double beside = operation.tool.radius + operation.prismatic->overhang.value_or(kOverhang);
    const bool one_way = operation.passes.traversal == Traversal::kOneWay;
    // with the uncut stock on the tool's left, which is behind it on the way to -x
    const bool climb = operation.passes.direction_of_cut == CutDirection::kClimb;
    double above = operation.prismatic->top;
    for (const double z : levels) {
        bool to_right = !climb;
        for (double k = 0; k < passes; ++k) {
            const double y = box.y0 + (box.y1 - box.y0) * (k + 0.5) / passes;
            const Vec2d from{to_right ? box.x0 - beside : box.x1 + beside, y};
            const Vec2d to{to_right ? box.x1 + beside : box.x0 - beside, y};
            if (k == 0 || one_way) {
                writer.approach(from, rapid_end(job, above));
                writer.line(MoveKind::kPlunge, {from.x, from.y, z});
            } else {
                writer.line(MoveKind::kLink, {from.x, from.y, z});
            }
            writer.line(MoveKind::kCut, {to.x, to.y, z});
            to_right = one_way ? to_right : !to_right;
        }
        above = z;
    }
    writer.retract();
    count_moves(writer, static_cast<int>(passes) * static_cast<int>(levels.size()),
                static_cast<int>(levels.size()), planned);
    planned.stats.counts.emplace_back("stepover_mm", (box.y1 - box.y0) / passes);
    return {planned};
}

}  // namespace cusp::prismatic
