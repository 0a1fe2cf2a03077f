// The row of stages.
#include "host_tools/cam/plan/plan.hpp"

#include <algorithm>
#include <utility>

#include "host_tools/cam/plan/stages.hpp"

#include "fmt/format.h"

namespace cusp::plan {

using job::Job;
using toolpath::PlannedOperation;
using toolpath::Toolpath;

namespace {

constexpr Stage kStages[]{
    take_machine,
    fit_to_post,
    read_earlier_programs,
    plan_operations,
    keep_rest,
    finish_paths,
    put_in_order,
    prove_edges,
    prove_rapids,
    measure_paths,
    prove_travel,
    prove_reach,
    find_air,
    warn,
    warn_of_cut_tabs,
    find_engagement,
    write_gcode,
    put_times,
    put_feeds_by_load,
    write_gcode,
    put_times,
    count_engagement,
    warn_of_thin_floors,
};

}  // namespace

void Watcher::operation(std::size_t, std::size_t, const std::string&) {}
void Watcher::begin(const std::string&) {}
void Watcher::progress(const char*, double) {}
bool Watcher::cancelled() { return false; }

void Planning::begin(const std::string& work) const
{
    if (watcher.cancelled()) {
        throw Cancelled{};
    }
    watcher.begin(work);
}

std::function<void(double)> Planning::reports(const char* work) const
{
    return [&watcher = watcher, work](double share) {
        watcher.progress(work, share);
    };
}

std::vector<std::string> PlannedProgram::all_warnings() const
{
    std::vector<std::string> all = warnings;
    for (const PlannedOperation& operation : operations) {
        all.insert(all.end(), operation.stats.warnings.begin(), operation.stats.warnings.end());
    }
    return all;
}

const job::Operation& operation_of(const Job& job, const PlannedOperation& planned)
{
    return *std::find_if(job.operations.begin(), job.operations.end(),
                         [&](const job::Operation& o) { return o.number == planned.operation; });
}

std::string words_of(const PlannedOperation& planned)
{
    return fmt::format("operation {}, {}", planned.operation, planned.stats.strategy);
}

std::vector<const Toolpath*> paths_of(const PlannedProgram& program)
{
    std::vector<const Toolpath*> paths;
    for (const PlannedOperation& operation : program.operations) {
        paths.push_back(&operation.path);
    }
    return paths;
}

PlannedProgram plan_job(Job& job, const PlanOptions& options, Watcher& watcher)
{
    Planning planning{job, options, watcher};
    planning.rates.exact_stop = !(options.blend > 0);
    for (const Stage stage : kStages) {
        if (watcher.cancelled()) {
            throw Cancelled{};
        }
        stage(planning);
    }
    job.progress = {};
    return std::move(planning.program);
}

void plan_setups(std::vector<Job>& setups,
                 Watcher& watcher,
                 const std::function<PlanOptions(const Job&)>& begin,
                 const std::function<void(const Job&, PlannedProgram)>& done)
{
    std::for_each(setups.begin(), setups.end(), check_offset);
    for (std::size_t k = 0; k < setups.size(); ++k) {
        Job& job = setups[k];
        const PlanOptions options = begin(job);
        PlannedProgram program = plan_job(job, options, watcher);
        for (std::size_t later = k + 1; later < setups.size(); ++later) {
            add_earlier_program(setups[later], *job.setup, options.name);
            setups[later].programs[options.name] = job.programs.at(options.name);
        }
        done(job, std::move(program));
        job.operations.clear();  // meshes are large
    }
}

}  // namespace cusp::plan
