// The stock is what earlier programs and earlier operations leave.
#include <algorithm>

#include "host_tools/cam/plan/rest_of_job.hpp"
#include "host_tools/cam/plan/stages.hpp"
#include "host_tools/job/job/thread.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::plan {

using job::Job;
using job::Operation;
using job::ToleranceSide;
using rest_machining::EndProfile;
using rest_machining::keep_rest;
using rest_machining::rest_tolerance;
using rest_machining::RestTolerance;
using rest_machining::SweptStock;
using rest_machining::take_away;
using toolpath::PlannedOperation;
using verify::earlier_cuts;
using verify::earlier_programs;
using verify::EarlierCut;

namespace {

void cut_from(const std::vector<EarlierCut>& cuts, SweptStock& stock)
{
    constexpr double kChord = 2e-4;  // mm
    for (const EarlierCut& cut : cuts) {
        stock.add(EndProfile{cut.tool, cut.is_chord ? kChord : 0.0}, cut.from, cut.to);
    }
}

}  // namespace

// Those of other set-ups only where they cut through.
std::vector<std::string> RestOfJob::programs_before(const Job& job,
                                                    const Operation& operation) const
{
    std::vector<std::string> files = job.stock_programs;
    for (const job::SetupProgram& program : job.turned_programs) {
        if (cuts_.count(program.file) > 0) {
            files.push_back(program.file);
        }
    }
    for (const std::string& file : operation.rest.after) {
        if (std::find(files.begin(), files.end(), file) == files.end()) {
            files.push_back(file);
        }
    }
    return files;
}

RestOfJob::RestOfJob(const Job& job)
{
    for (const std::string& file : earlier_programs(job)) {
        cuts_.emplace(file, earlier_cuts(job, file));
    }
    for (const job::SetupProgram& program : job.turned_programs) {
        std::vector<EarlierCut> cuts = earlier_cuts(job, program);
        if (!cuts.empty()) {
            cuts_.emplace(program.file, std::move(cuts));
        }
    }
    for (const Operation& operation : job.operations) {
        if (!programs_before(job, operation).empty()) {
            tolerances_.insert_or_assign(operation.number, rest_tolerance(operation));
        }
    }
}

void RestOfJob::remember(const std::vector<PlannedOperation>& results)
{
    if (!cuts_.empty()) {
        for (const PlannedOperation& result : results) {
            paths_.push_back(result.path);
        }
    }
}

bool RestOfJob::lower_scallop(const Job& job, Operation& operation) const
{
    if (programs_before(job, operation).empty() || !operation.tolerance.scallop ||
        operation.rest.tolerance) {
        return false;
    }
    const double least =
        operation.tolerance.side == ToleranceSide::kOutside ? operation.tolerance.floor : 0;
    const double lower = *operation.tolerance.scallop - tolerances_.at(operation.number).surface;
    if (lower > least) {
        operation.tolerance.scallop = lower;
    }
    return lower > least;
}

bool RestOfJob::keep(const Job& job,
                     const Operation& operation,
                     std::vector<PlannedOperation>& results) const
{
    // A thread is cut whole: what is left of a turn is no groove.
    if (cuts_.empty() || thread_of(operation) != nullptr) {
        return false;
    }
    const std::vector<std::string> programs = programs_before(job, operation);
    for (PlannedOperation& result : results) {
        if (!programs.empty() && !result.path.moves.empty()) {
            SweptStock stock{job.stock_top};
            for (const std::string& file : programs) {
                cut_from(cuts_.at(file), stock);
            }
            for (const toolpath::Toolpath& path : paths_) {
                take_away(path, stock);
            }
            keep_rest(stock, job, {programs, tolerances_.at(operation.number)}, result);
        }
    }
    const bool nothing = std::all_of(results.begin(), results.end(), [](const auto& result) {
        return result.stats.rest && result.path.moves.empty();
    });
    if (nothing && !results.empty()) {
        results.front().stats.warnings.push_back(fmt::format(
            "operation {}, {}: nothing thicker than {:g} mm is left after {}: nothing is cut",
            operation.number, operation.name(), tolerances_.at(operation.number).surface,
            fmt::join(programs, ", ")));
    }
    return !nothing;
}

void read_earlier_programs(Planning& planning) { planning.rest = RestOfJob{planning.job}; }

void keep_rest(Planning& planning)
{
    Job& job = planning.job;
    const RestOfJob& rest = planning.rest;
    for (Planned& planned : planning.planned) {
        Operation& operation = job.operations[planned.place];
        planning.begin(fmt::format("looking for what is left for operation {} ({}) of {}",
                                   operation.number, operation.name(), job.file));
        if (rest.keep(job, operation, planned.paths) && rest.lower_scallop(job, operation)) {
            planned.paths = plan_operation_at(planning, planned.place);
            rest.keep(job, operation, planned.paths);
        }
        planning.rest.remember(planned.paths);
    }
}

}  // namespace cusp::plan
