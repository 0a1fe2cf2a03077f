// Equal levels: the last one is no thinner than the others.
#include "host_tools/cam/prismatic/cut_levels.hpp"

#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using job::Job;
using job::Operation;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;

std::vector<double> cut_levels(const Job& job, const Operation& operation, double depth)
{
    constexpr double kMost = 1000;
    constexpr double kRounding = 1e-9;
    const double top = operation.prismatic->top;
    const double count = std::ceil(depth / operation.levels.max_depth.value_or(depth) - kRounding);
    if (count > kMost) {
        throw InputError(fmt::format(
            "{}max_depth {:g} mm makes {:g} levels of {:g} mm, the limit "
            "is {:g}",
            operation_text(job, operation), *operation.levels.max_depth, count, depth, kMost));
    }
    std::vector<double> levels;
    for (double k = 1; k <= count; ++k) {
        levels.push_back(k < count ? top - depth * k / count : top - depth);
    }
    return levels;
}

PlannedOperation begun(const Job& job, const Operation& operation, const std::string& comment)
{
    PlannedOperation planned;
    set_tool(planned.path, job, operation.tool);
    planned.path.comments = {operation.name() + ": " + comment};
    planned.stats.strategy = operation.name();
    return planned;
}

void count_moves(const ToolpathWriter& writer, int passes, int levels, PlannedOperation& planned)
{
    planned.stats.passes = passes;
    planned.stats.levels = levels;
    planned.stats.cl_points = static_cast<int>(planned.path.moves.size());
    planned.stats.retracts = writer.retracts();
    if (writer.steep_plunges() > 0) {
        planned.stats.warnings.push_back(fmt::format(
            "{} had no room for a slope and {}",
            counted(static_cast<std::size_t>(writer.steep_plunges()), "entry", "entries"),
            writer.steep_plunges() == 1 ? "plunges" : "plunge"));
    }
}

double chord_tolerance(const Operation& operation)
{
    const double across = operation.tolerance.plan / 2;
    return is_conical(operation.tool)
               ? std::min(across, operation.tolerance.floor / 2 *
                                      elementary::tan(operation.tool.tip_angle / 2))
               : across;
}

std::string operation_text(const Job& job, const Operation& operation)
{
    return fmt::format("{}: operation {}: {}: ", job.file, operation.number, operation.name());
}

}  // namespace cusp::prismatic
