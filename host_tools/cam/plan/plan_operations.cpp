// One strategy after the other; within one, roughing and finish at once.
#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/plan/stages.hpp"
#include "host_tools/cam/strategies/strategies.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::plan {

using job::Job;
using job::kRoughingDone;
using job::Operation;
using job::PocketRefusal;
using strategies::plan_operation;
using toolpath::PlannedOperation;

namespace {

double seconds_since(std::chrono::steady_clock::time_point begin)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Roughing and finish are planned at once, by two threads that report shares of the same operation.
class PartsProgress {
public:
    PartsProgress(bool roughs, std::function<void(double)> shown)
        : roughs_{roughs}, shown_{std::move(shown)}
    {
    }

    void operator()(double share)
    {
        const std::lock_guard lock{guard_};
        double& part = roughs_ && share <= kRoughingDone ? rough_ : finish_;
        part = std::max(part, share);
        const double begun = roughs_ ? kRoughingDone : 0.0;
        shown_(share >= 1 ? 1.0 : rough_ + std::max(0.0, finish_ - begun));
    }

private:
    std::mutex guard_;
    bool roughs_;
    double rough_{};
    double finish_{};
    std::function<void(double)> shown_;
};

// Leaves out pockets that the tool does not fit into, where a drawing has several.
std::vector<PlannedOperation> paths_of(const Operation& operation, Planning& planning)
{
    const Job& job = planning.job;
    const auto is_of_same_table = [&](const Operation& other) {
        return other.number == operation.number;
    };
    try {
        return plan_operation(job, operation);
    } catch (const PocketRefusal& error) {
        if (std::count_if(job.operations.begin(), job.operations.end(), is_of_same_table) < 2) {
            throw;
        }
        planning.program.warnings.push_back(std::string{error.what()} + ": left out");
        return {};
    }
}

}  // namespace

std::vector<PlannedOperation> plan_operation_at(Planning& planning, std::size_t place)
{
    Job& job = planning.job;
    const Operation& operation = job.operations[place];
    planning.begin(fmt::format("planning operation {} of {} ({}) of {}", place + 1,
                               job.operations.size(), operation.name(), job.file));
    const auto begin = std::chrono::steady_clock::now();
    const auto progress =
        std::make_shared<PartsProgress>(operation.passes.roughing, planning.reports("planning"));
    job.progress = [progress](double share) {
        (*progress)(share);
    };
    std::vector<PlannedOperation> paths = paths_of(operation, planning);
    job.report_progress(1.0);
    for (PlannedOperation& path : paths) {
        if (path.stats.planning_s <= 0) {
            path.stats.planning_s = seconds_since(begin) / static_cast<double>(paths.size());
        }
    }
    return paths;
}

void plan_operations(Planning& planning)
{
    const std::vector<Operation>& operations = planning.job.operations;
    for (std::size_t i = 0; i < operations.size(); ++i) {
        planning.watcher.operation(i + 1, operations.size(), operations[i].name());
        planning.planned.push_back({i, plan_operation_at(planning, i)});
    }
}

}  // namespace cusp::plan
