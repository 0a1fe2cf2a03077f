// Rapid moves are looked at in the stock as it is by then, before a line is written.
#include <algorithm>
#include <map>

#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/plan/lifted_path.hpp"
#include "host_tools/cam/plan/stages.hpp"
#include "host_tools/job/job/fixture_clearance.hpp"
#include "host_tools/judge/verify/path_rapids.hpp"

#include "fmt/format.h"

namespace cusp::plan {

using job::Job;
using job::keep_off_fixtures;
using job::Operation;
using toolpath::PlannedOperation;
using toolpath::Toolpath;
using verify::RapidInStock;
using verify::rapids_in_stock;

namespace {

bool is_less_deep(const RapidInStock& a, const RapidInStock& b) { return a.depth < b.depth; }

bool ends_less_deep(const RapidInStock& a, const RapidInStock& b)
{
    return a.end_depth < b.end_depth;
}

// Errors: InputError if a rapid move would cut into stock that earlier operations and programs leave: operation, place,
// depth and limit.
void refuse_rapids(const Job& job, const PlannedProgram& program)
{
    const std::vector<RapidInStock> rapids = rapids_in_stock(job, paths_of(program));
    const auto rapid = std::max_element(rapids.begin(), rapids.end(), is_less_deep);
    if (rapid == rapids.end()) {
        return;
    }
    const PlannedOperation& operation = program.operations[rapid->path];
    throw InputError(fmt::format(
        "{}: {}: a rapid move of tool {} to x {:.3f} y {:.3f} z {:.3f} mm would cut "
        "{:.4g} mm deep into stock that is there by then, the limit is {:g}: let an operation "
        "before it cut that stock away, or begin this one at its top",
        job.file, words_of(operation), operation.path.tool.number, rapid->tip.x, rapid->tip.y,
        rapid->tip.z, rapid->depth, verify::kRapidCutAllowed));
}

// mm: the depth of one cut of the operation.
double most_in_one_plunge(const Operation& operation, const Toolpath& path)
{
    if (path.cycle && path.cycle->peck > 0) {
        return kUnbounded;  // it pecks through that stock too
    }
    return operation.levels.max_depth.value_or(2 * path.tool.radius);
}

// Errors: InputError if an operation whose top is below standing stock would plunge through more of it than one cut:
// operation, place, depth and limit.
void refuse_deep_plunges(const Job& job,
                         const PlannedOperation& planned,
                         const std::vector<RapidInStock>& rapids)
{
    const Operation& operation = operation_of(job, planned);
    if (!operation.prismatic || operation.prismatic->top >= job.stock_top) {
        return;
    }
    const auto deepest = std::max_element(rapids.begin(), rapids.end(), ends_less_deep);
    const double most = most_in_one_plunge(operation, planned.path);
    if (deepest->end_depth <= most) {
        return;
    }
    throw InputError(fmt::format(
        "{}: operation {}, {}: begins at z {:.4g} mm, below {:.4g} mm of stock that stands by then "
        "at x {:.3f} y {:.3f}: tool {} plunges at most {:.4g} mm at once ({}). Let an operation "
        "before it cut that stock away, or raise top",
        job.file, operation.number, operation.name(), operation.prismatic->top, deepest->end_depth,
        deepest->tip.x, deepest->tip.y, planned.path.tool.number, most,
        operation.levels.max_depth ? "max_depth" : "its diameter"));
}

}  // namespace

void prove_rapids(Planning& planning)
{
    const Job& job = planning.job;
    PlannedProgram& program = planning.program;
    planning.begin("checking rapid moves");
    std::map<std::size_t, std::vector<RapidInStock>> by_path;
    for (const RapidInStock& rapid : rapids_in_stock(job, paths_of(program))) {
        by_path[rapid.path].push_back(rapid);
    }
    for (const auto& [path, rapids] : by_path) {
        PlannedOperation& operation = program.operations[path];
        refuse_deep_plunges(job, operation, rapids);
        const std::string name = words_of(operation);
        operation.path = lifted(operation.path, rapids, job.stock_top + job.clearance);
        operation.stats.retracts += keep_off_fixtures(job, name, operation.path);
        const auto deepest = std::max_element(rapids.begin(), rapids.end(), is_less_deep);
        program.warnings.push_back(fmt::format(
            "{}: it begins below stock that stands by then, up to {:.4g} mm of it at x {:.3f} y "
            "{:.3f}: tool {} goes through it at the plunge feed, at {}",
            name, deepest->depth, deepest->tip.x, deepest->tip.y, operation.path.tool.number,
            counted(rapids.size(), "place")));
    }
    if (!by_path.empty()) {
        refuse_rapids(job, program);
    }
}

}  // namespace cusp::plan
