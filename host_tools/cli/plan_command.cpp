// cusp plan: from a job file to G-code and its statistics.
#include <memory>
#include <string>

#include "host_tools/cli/commands.hpp"
#include "host_tools/cli/plan_program.hpp"
#include "host_tools/cli/plan_statistics.hpp"
#include "host_tools/import/job.hpp"

#include "CLI/CLI.hpp"

namespace cusp::host {
namespace {

struct PlanOptions {
    std::string job;
    PlanOutput output;
};

int run_plan(const PlanOptions& options)
{
    Job job = read_job(options.job);
    const Plan plan = plan_program(job, "job " + options.job, options.output);
    print_summary(plan, job.notes, options.output.program, options.output.said);
    return kDone;
}

}  // namespace

void add_plan_command(CLI::App& app, Work& work)
{
    auto* command = app.add_subcommand("plan", "plan the operations of a job and write G-code");
    command->footer(
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
    command->add_option("JOB", options->job, "job file (TOML)")->required();
    command->add_option("-o,--output", options->output.program, "G-code to write")->required();
    command->add_option("--stats", options->output.stats, "statistics to write (JSON)");
    command
        ->add_option("--blend", options->output.blend,
                     "let the controller round corners by this much, in the job's units (G64 P); "
                     "default: the exact path (G61)")
        ->check(CLI::NonNegativeNumber);
    command->callback([&work, options] {
        work = [options] {
            return run_plan(*options);
        };
    });
}

}  // namespace cusp::host
