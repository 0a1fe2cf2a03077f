// Plans operation by operation; writes files when all are planned.
#include "host_tools/cli/plan_program.hpp"

#include <chrono>
#include <sstream>

#include "host_tools/cli/share_progress.hpp"
#include "host_tools/cli/strategies.hpp"
#include "host_tools/files/files.hpp"
#include "host_tools/input_error/input_error.hpp"
#include "host_tools/toolpath/gcode_writer.hpp"
#include "host_tools/toolpath/toolpath_measure.hpp"

#include "fmt/format.h"
#include "nlohmann/json.hpp"

namespace cusp::cli {

using files::write_text;
using job::Job;
using job::Operation;
using toolpath::MachineRates;
using toolpath::PlannedOperation;
using toolpath::ProgramForm;

namespace {

double seconds_since(std::chrono::steady_clock::time_point begin)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Plan plan_job(Job& job, const MachineRates& rates, std::FILE* said)
{
    constexpr double kQuiet = 0.5;  // s
    Plan plan;
    // the position of the tool is unknown before the first rapid move
    Vec3d at{0, 0, job.stock_top + job.clearance};
    for (std::size_t i = 0; i < job.operations.size(); ++i) {
        const Operation& operation = job.operations[i];
        fmt::print(said, "operation {} of {}: {}\n", i + 1, job.operations.size(),
                   operation.strategy);
        std::fflush(said);
        const auto begin = std::chrono::steady_clock::now();
        job.progress = ShareProgress{"planning", kQuiet};
        std::vector<PlannedOperation> planned = plan_operation(job, operation);
        job.report_progress(1.0);
        const double seconds = seconds_since(begin) / static_cast<double>(planned.size());
        for (PlannedOperation& result : planned) {
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

void write_plan(const Job& job,
                const std::string& title,
                const PlanOutput& output,
                const Plan& plan)
{
    ProgramForm form{
        "cusp " CUSP_VERSION ", " + title, job.inch, job.stock_top + job.clearance, {}};
    if (output.blend > 0) {
        form.blend_tolerance = output.blend * (job.inch ? 25.4 : 1.0);
    }
    std::ostringstream lines;
    write_program(lines, form, plan.operations);
    const std::string program = lines.str();
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
        throw InputError(job.file + ": no operation leaves anything to cut");
    }
    write_plan(job, title, output, plan);
    return plan;
}

}  // namespace cusp::cli
