// cusp verify: simulates the cut and compares the remaining stock with the part.
#include <memory>

#include "host_tools/cancellation/cancellation.hpp"
#include "host_tools/cli/commands.hpp"
#include "host_tools/cli/resource_options.hpp"
#include "host_tools/cli/verify_program.hpp"
#include "host_tools/import/import.hpp"
#include "host_tools/job/job.hpp"

#include "CLI/CLI.hpp"
#include "fmt/format.h"

namespace cusp::cli {

using import::read_job;
using verify::Verification;
using verify::VerifySettings;

namespace {

struct VerifyOptions {
    std::string job;
    std::string program;
    VerifyOutput output;
    double pitch{};
    double spacing{};
    Resources resources;
};

int run_verify(const VerifyOptions& options)
{
    apply(options.resources);
    cancellation::set_work("reading " + options.job);
    VerifySettings settings;
    if (options.pitch > 0) {
        settings.pitch = options.pitch;
    }
    if (options.spacing > 0) {
        settings.spacing = options.spacing;
    }
    const Verification result =
        verify_program(read_job(options.job), options.program, settings, options.output);
    fmt::print("{}", verification_text(result));
    return result.broken.empty() ? kDone : kFoundWrong;
}

}  // namespace

void add_verify_command(CLI::App& app, Work& work)
{
    auto* command = app.add_subcommand(
        "verify", "simulate the cut; report gouge, scallop and the remaining stock");
    command->footer(
        "Gouge and scallop are measured square to the surface, in mm, whatever the job's units.\n"
        "Exit status 1 where a bound of the job does not hold: floor_tolerance (gouge),\n"
        "plan_tolerance (walls), scallop (on 99 % of what the tools reach; stock on the rest may\n"
        "be no thicker than scallop and floor_tolerance), or where a rapid move cuts stock.");
    auto options = std::make_shared<VerifyOptions>();
    command->add_option("JOB", options->job, "job file (TOML)")->required();
    command->add_option("PROGRAM", options->program, "G-code")->required();
    command->add_option("--stats", options->output.stats, "figures to write (JSON)");
    command
        ->add_option("--grid", options->pitch,
                     "mm between compared heights (default 0.173 or finer)")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--step", options->spacing, "mm between tool positions (default 0.1 or finer)")
        ->check(CLI::PositiveNumber);
    command->add_option("--path-picture", options->output.path_picture,
                        "picture to write (SVG): the path from above, coloured by height");
    command->add_option("--left-picture", options->output.left_picture,
                        "picture to write (SVG): the material left above the floor");
    add_resource_options(*command, options->resources);
    run_when_called(*command, work, options, run_verify);
}

}  // namespace cusp::cli
