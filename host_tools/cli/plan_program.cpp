// Plans all operations, then writes the files.
#include "host_tools/cli/plan_program.hpp"

#include <algorithm>
#include <chrono>
#include <sstream>

#include "host_tools/cli/share_progress.hpp"
#include "host_tools/cli/simulated_times.hpp"
#include "host_tools/cli/stock_warning.hpp"
#include "host_tools/files/files.hpp"
#include "host_tools/input_error/input_error.hpp"
#include "host_tools/strategies/strategies.hpp"
#include "host_tools/toolpath/gcode_writer.hpp"
#include "host_tools/toolpath/toolpath_measure.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "nlohmann/json.hpp"

namespace cusp::cli {

using files::write_text;
using job::Job;
using job::Operation;
using job::PocketRefusal;
using strategies::plan_operation;
using toolpath::MachineRates;
using toolpath::PathMeasure;
using toolpath::PlannedOperation;
using toolpath::ProgramForm;

namespace {

double seconds_since(std::chrono::steady_clock::time_point begin)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Leaves out pockets that the tool does not fit into, where a drawing has several.
std::vector<PlannedOperation> planned(const Job& job, const Operation& operation, Plan& plan)
{
    const auto is_of_same_table = [&](const Operation& other) {
        return other.number == operation.number;
    };
    try {
        return plan_operation(job, operation);
    } catch (const PocketRefusal& error) {
        if (std::count_if(job.operations.begin(), job.operations.end(), is_of_same_table) < 2) {
            throw;
        }
        plan.warnings.push_back(std::string{error.what()} + ": left out");
        return {};
    }
}

Plan plan_job(Job& job, const MachineRates& rates, std::FILE* said)
{
    constexpr double kQuiet = 0.5;  // s
    Plan plan;
    // the position of the tool before the first rapid move is unknown: the clearance height
    Vec3d at{0, 0, job.stock_top + job.clearance};
    for (std::size_t i = 0; i < job.operations.size(); ++i) {
        const Operation& operation = job.operations[i];
        fmt::print(said, "operation {} of {}: {}\n", i + 1, job.operations.size(),
                   operation.strategy);
        std::fflush(said);
        const auto begin = std::chrono::steady_clock::now();
        job.progress = ShareProgress{"planning", kQuiet};
        std::vector<PlannedOperation> results = planned(job, operation, plan);
        job.report_progress(1.0);
        const double seconds = seconds_since(begin) / static_cast<double>(results.size());
        for (PlannedOperation& result : results) {
            if (result.path.moves.empty()) {
                const auto& why = result.stats.warnings;
                plan.warnings.insert(plan.warnings.end(), why.begin(), why.end());
                continue;
            }
            if (result.stats.planning_s <= 0) {
                result.stats.planning_s = seconds;
            }
            plan.measures.push_back(measure(result.path, at, rates));
            at = plan.measures.back().end;
            plan.operations.push_back(std::move(result));
        }
    }
    return plan;
}

// Replaces the estimates of `measure` by simulated times, except in very long programs: a day of
// machine time takes a minute to simulate.
void put_simulated_times(const std::string& program,
                         const std::vector<std::size_t>& begins,
                         Plan& plan)
{
    constexpr double kLongest = 12 * 3600;  // s
    double measured = 0;
    for (const PathMeasure& measure : plan.measures) {
        measured += measure.estimated_s;
    }
    if (measured > kLongest) {
        return;
    }
    constexpr double kQuiet = 2.0;  // s
    const ShareProgress timing{"timing", kQuiet};
    if (const auto seconds = simulated_times(program, begins, timing)) {
        for (std::size_t i = 0; i < plan.measures.size(); ++i) {
            plan.measures[i].estimated_s = (*seconds)[i];
        }
    }
}

// The G-code. Sets the times in the plan to those on the controller.
std::string program_of(const Job& job, const std::string& title, double blend, Plan& plan)
{
    constexpr double kInch = 25.4;
    ProgramForm form{
        "cusp " CUSP_VERSION ", " + title, job.inch, job.stock_top + job.clearance, {}};
    if (blend > 0) {
        form.blend_tolerance = blend * (job.inch ? kInch : 1.0);
    }
    std::ostringstream lines;
    const std::vector<std::size_t> begins = write_program(lines, form, plan.operations);
    std::string program = lines.str();
    put_simulated_times(program, begins, plan);
    return program;
}

void write_plan(const Job& job,
                const std::string& program,
                const PlanOutput& output,
                const Plan& plan)
{
    write_text(output.program, program);
    if (!output.stats.empty()) {
        nlohmann::ordered_json about{
            {"job", job.file}, {"units", job.inch ? "inch" : "mm"}, {"bytes", program.size()}};
        if (!job.notes.empty()) {
            about["notes"] = job.notes;
        }
        write_text(output.stats, plan_statistics(plan, about).dump(1) + "\n");
    }
}

}  // namespace

Plan plan_program(Job& job, const std::string& title, const PlanOutput& output)
{
    MachineRates rates;
    rates.exact_stop = !(output.blend > 0);
    Plan plan = plan_job(job, rates, output.said);
    if (plan.operations.empty()) {
        throw InputError(fmt::format("{}: there is nothing to cut: {}", job.file,
                                     fmt::join(plan.warnings, "; ")));
    }
    if (const auto warning = stock_warning(job, plan)) {
        plan.warnings.push_back(*warning);
    }
    write_plan(job, program_of(job, title, output.blend, plan), output, plan);
    return plan;
}

}  // namespace cusp::cli
