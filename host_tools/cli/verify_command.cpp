// cusp verify: cuts a program in memory and compares what is left with the part.
#include <memory>

#include "host_tools/cli/commands.hpp"
#include "host_tools/cli/resource_options.hpp"
#include "host_tools/cli/verify_program.hpp"
#include "host_tools/import/import.hpp"
#include "host_tools/job/job.hpp"
#include "host_tools/work_place/work_place.hpp"

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
    work_place::set_work("reading " + options.job);
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
        "verify", "cut a program's stock in memory; report gouge, scallop and what is left");
    command->footer(
        "Gouge and scallop are measured square to the surface, in mm, whatever the job's units.\n"
        "Exit status 1 where a bound of the job does not hold: floor_tolerance (gouge),\n"
        "plan_tolerance (walls), scallop (on 99 % of what the tools reach; what stands on the "
        "rest\n"
        "may be no thicker than scallop and floor_tolerance), or where a rapid move cuts metal.");
    auto options = std::make_shared<VerifyOptions>();
    command->add_option("JOB", options->job, "job file (TOML)")->required();
    command->add_option("PROGRAM", options->program, "G-code")->required();
    command->add_option("--stats", options->output.stats, "figures to write (JSON)");
    command
        ->add_option("--grid", options->pitch,
                     "mm between the heights looked at (default 0.173 or finer)")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--step", options->spacing, "mm between tool positions (default 0.1 or finer)")
        ->check(CLI::PositiveNumber);
    command->add_option("--path-picture", options->output.path_picture,
                        "picture to write (SVG): the path from above, coloured by height");
    command->add_option("--left-picture", options->output.left_picture,
                        "picture to write (SVG): what is left over the floor");
    add_resource_options(*command, options->resources);
    command->callback([&work, options] {
        work = [options] {
            return run_verify(*options);
        };
    });
}

}  // namespace cusp::cli
