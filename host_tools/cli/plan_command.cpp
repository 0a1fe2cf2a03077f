// cusp plan: from a job file, or from parts and tools, to G-code and its statistics.
#include <chrono>
#include <cstdio>
#include <memory>
#include <sstream>

#include "host_tools/cli/commands.hpp"
#include "host_tools/cli/one_line_options.hpp"
#include "host_tools/cli/plan_statistics.hpp"
#include "host_tools/cli/share_progress.hpp"
#include "host_tools/cli/strategies.hpp"
#include "host_tools/import/job.hpp"
#include "host_tools/import/part_files.hpp"
#include "host_tools/input_error/input_error.hpp"
#include "host_tools/simulate/text_file.hpp"
#include "host_tools/toolpath/gcode_writer.hpp"
#include "host_tools/toolpath/toolpath_measure.hpp"

#include "CLI/CLI.hpp"
#include "fmt/format.h"
#include "nlohmann/json.hpp"

namespace cusp::host {
namespace {

struct PlanOptions {
    PlanCall call;
    std::string output;
    std::string stats;
    double blend{};

    // Where a job is printed, the standard output is its file.
    std::FILE* said() const { return call.print_job ? stderr : stdout; }
};

double seconds_since(std::chrono::steady_clock::time_point begin)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// The job only learns whom to tell of its progress: a copy of large meshes takes much memory.
Plan plan_job(Job& job, const MachineRates& rates, std::FILE* said)
{
    constexpr double kQuiet = 0.5;  // s
    Plan plan;
    // where the tool stands is not known before the first rapid move
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

// The job that parts and options amount to; printed, and read as if it were a file.
Job one_line_job_of(const PlanOptions& options)
{
    PartFiles parts;
    const OneLineJob job = one_line_job(options.call.request, parts);
    for (const std::string& line : job.said) {
        fmt::print(options.said(), "{}\n", line);
    }
    std::fflush(options.said());
    if (options.call.print_job) {
        fmt::print("{}", job.toml);
    }
    return read_job({job.toml, options.call.job_name(), ""}, parts);
}

void write_plan(const PlanOptions& options, const Job& job, const Plan& plan)
{
    const std::string name = options.call.job_name();
    const std::string title = (options.call.is_one_line() ? "" : "job ") + name;
    ProgramForm form{
        "cusp " CUSP_VERSION ", " + title, job.inch, job.stock_top + job.clearance, {}};
    if (options.blend > 0) {
        form.blend_tolerance = options.blend * (job.inch ? 25.4 : 1.0);
    }
    std::ostringstream lines;
    write_program(lines, form, plan.operations);
    const std::string program = lines.str();
    write_text(options.output, program);
    if (!options.stats.empty()) {
        nlohmann::ordered_json about{
            {"job", name}, {"units", job.inch ? "inch" : "mm"}, {"bytes", program.size()}};
        if (!job.notes.empty()) {
            about["notes"] = job.notes;
        }
        write_text(options.stats, plan_statistics(plan, about).dump(1) + "\n");
    }
}

int run_plan(const PlanOptions& options)
{
    const bool one_line = options.call.is_one_line();
    if (options.output.empty() && !options.call.print_job) {
        throw InputError("plan: -o is required: the G-code to write, such as -o part.ngc");
    }
    Job job = one_line ? one_line_job_of(options) : read_job(options.call.files.front());
    if (options.output.empty()) {
        return kDone;
    }
    MachineRates rates;
    rates.exact_stop = !(options.blend > 0);
    const Plan plan = plan_job(job, rates, options.said());
    if (plan.operations.empty()) {
        throw InputError(options.call.job_name() + ": no operation leaves anything to cut");
    }
    write_plan(options, job, plan);
    print_summary(plan, job.notes, options.output, options.said());
    return kDone;
}

}  // namespace

void add_plan_command(CLI::App& app, Work& work)
{
    auto* command = app.add_subcommand("plan", "plan a job, or parts and tools, and write G-code");
    command->footer(
        "Without a job file:\n"
        "  cusp plan part.step --tool ball:6 --scallop 0.02 -o part.ngc\n"
        "  cusp plan part.stl --tool flat:8 ball:6 --scallop 0.05 --feed 800 -o part.ngc\n"
        "  cusp plan floor.json --boundary plate.dxf#outline --island boss.json --tool ball:12 \\\n"
        "            --scallop 0.4 -o pocket.ngc\n"
        "What is chosen for you is said. The same call with --print-job instead of -o prints the\n"
        "job file, to change and to plan: ... --print-job > part.toml\n\n"
        "Strategies: contour_pocket, adaptive_isocurve, grid_pocket, hull_rough; for comparison\n"
        "complete_isocurves and parallel_planes. Statistics are in mm and s, whatever the job's\n"
        "units.\n\n"
        "A job, all of whose keys docs/job_file.md tells:\n"
        "  units = \"mm\"\n"
        "  [tool]\n"
        "  shape = \"ball\"                  # \"flat\", \"bull\"\n"
        "  diameter = 6.0\n"
        "  [cutting]\n"
        "  feed = 1200.0                   # a minute\n"
        "  [stock]\n"
        "  top = 0.0\n"
        "  [[operation]]\n"
        "  strategy = \"adaptive_isocurve\"\n"
        "  floor = [\"part.step\"]           # .json, .step, .igs, .stl\n"
        "  scallop = 0.02                  # tolerance included\n"
        "  floor_tolerance = 0.01\n"
        "  output = \"arcs\"                 # \"lines\", \"nurbs\"\n"
        "Pockets (contour_pocket, grid_pocket) add boundary = \"outline.dxf\", islands = [...];\n"
        "layers are asked for by max_depth.");
    auto options = std::make_shared<PlanOptions>();
    command->add_option("JOB", options->call.files,
                        "job file (.toml), or parts: .json, .step, .iges, .stl");
    command->add_option("-o,--output", options->output, "G-code to write");
    command->add_option("--stats", options->stats, "statistics to write (JSON)");
    command
        ->add_option("--blend", options->blend,
                     "let the controller round corners by this much, in the job's units (G64 P); "
                     "default: the exact path (G61)")
        ->check(CLI::NonNegativeNumber);
    add_one_line_options(*command, options->call);
    command->callback([&work, command, options] {
        work = [command, options] {
            sort_call(*command, options->call);
            return run_plan(*options);
        };
    });
}

}  // namespace cusp::host
