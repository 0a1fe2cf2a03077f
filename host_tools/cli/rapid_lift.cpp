// Rapid moves are looked at in the stock as it is by then, before a line is written.
#include "host_tools/cli/rapid_lift.hpp"

#include <algorithm>
#include <map>

#include "host_tools/base/cancellation/cancellation.hpp"
#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cli/lifted_path.hpp"
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"
#include "host_tools/job/job/fixture_clearance.hpp"
#include "host_tools/judge/verify/path_rapids.hpp"

#include "fmt/format.h"

namespace cusp::cli {

using job::Job;
using job::keep_off_fixtures;
using toolpath::PlannedOperation;
using verify::RapidInStock;
using verify::rapids_in_stock;

void lift_rapids(const Job& job, Plan& plan)
{
    cancellation::set_work("checking rapid moves");
    std::map<std::size_t, std::vector<RapidInStock>> by_path;
    for (const RapidInStock& rapid : rapids_in_stock(job, paths_of(plan))) {
        by_path[rapid.path].push_back(rapid);
    }
    for (const auto& [path, rapids] : by_path) {
        PlannedOperation& operation = plan.operations[path];
        const std::string name =
            fmt::format("operation {}, {}", operation.operation, operation.stats.strategy);
        operation.path = lifted(operation.path, rapids, job.stock_top + job.clearance);
        operation.stats.retracts += keep_off_fixtures(job, name, operation.path);
        const auto deepest = std::max_element(
            rapids.begin(), rapids.end(),
            [](const RapidInStock& a, const RapidInStock& b) { return a.depth < b.depth; });
        plan.warnings.push_back(fmt::format(
            "{}: it begins below stock that stands by then, up to {:.4g} mm of it at x {:.3f} y "
            "{:.3f}: tool {} goes through it at the plunge feed, at {}",
            name, deepest->depth, deepest->tip.x, deepest->tip.y, operation.path.tool.number,
            counted(rapids.size(), "place")));
    }
    if (!by_path.empty()) {
        refuse_rapids(job, plan);
    }
}

void refuse_rapids(const Job& job, const Plan& plan)
{
    const std::vector<RapidInStock> rapids = rapids_in_stock(job, paths_of(plan));
    const auto rapid = std::max_element(
        rapids.begin(), rapids.end(),
        [](const RapidInStock& a, const RapidInStock& b) { return a.depth < b.depth; });
    if (rapid == rapids.end()) {
        return;
    }
    const PlannedOperation& operation = plan.operations[rapid->path];
    throw InputError(fmt::format(
        "{}: operation {}, {}: a rapid move of tool {} to x {:.3f} y {:.3f} z {:.3f} mm would cut "
        "{:.4g} mm deep into stock that is there by then, the limit is {:g}: let an operation "
        "before it cut that stock away, or begin this one at its top",
        job.file, operation.operation, operation.stats.strategy, operation.path.tool.number,
        rapid->tip.x, rapid->tip.y, rapid->tip.z, rapid->depth, verify::kRapidCutAllowed));
}

}  // namespace cusp::cli
