// cusp verify: simulates the cut and compares the remaining stock with the part.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/base/cancellation/cancellation.hpp"
#include "host_tools/cli/cli.hpp"
#include "host_tools/cli/program_job.hpp"
#include "host_tools/cli/resource_options.hpp"
#include "host_tools/cli/share_progress.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/report/report.hpp"
#include "host_tools/judge/verify/verify_statistics.hpp"

#include "CLI/CLI.hpp"
#include "fmt/format.h"

namespace cusp::cli {

using job::Job;

namespace {

// Files to write; empty: none.
struct VerifyOutput {
    std::string stats;               // JSON
    std::string path_picture;        // SVG
    std::string left_picture;        // SVG
    std::string engagement_picture;  // SVG
};

struct VerifyOptions {
    std::string job;
    std::string program;
    std::vector<std::string> after;
    VerifyOutput output;
    double pitch{};
    double spacing{};
    std::optional<double> max_engagement;
    Resources resources;
};

constexpr double kLeastEngagement = 1;
constexpr double kMostEngagement = 180;

// CLI::Range lets nan pass.
std::string refusal_of_engagement(const std::string& text)
{
    double value = 0;
    const bool is_number = CLI::detail::lexical_cast(text, value);
    if (is_number && value >= kLeastEngagement && value <= kMostEngagement) {
        return {};
    }
    return fmt::format("{} degrees is not between {:g} and {:g} degrees", text, kLeastEngagement,
                       kMostEngagement);
}

// It takes time, so not for the figures that are printed alone.
bool asks_for_engagement(const VerifyOptions& options, const Job& job)
{
    return options.max_engagement || !options.output.stats.empty() ||
           !options.output.engagement_picture.empty() ||
           std::any_of(job.operations.begin(), job.operations.end(), [](const auto& operation) {
               return operation.passes.max_engagement.has_value();
           });
}

void write_output(const Job& job, const verify::Verification& result, const VerifyOutput& output)
{
    const cancellation::FinishOutput finish;
    write_wanted(output.stats, [&] { return statistics_json(result); });
    write_wanted(output.path_picture, [&] { return report::path_picture(job, result.program); });
    write_wanted(output.left_picture, [&] { return report::left_picture(job, result); });
    write_wanted(output.engagement_picture,
                 [&] { return report::engagement_picture(job, result); });
}

int run_verify(const VerifyOptions& options)
{
    apply(options.resources);
    cancellation::set_work("reading " + options.job);
    verify::VerifySettings settings;
    if (options.pitch > 0) {
        settings.pitch = options.pitch;
    }
    if (options.spacing > 0) {
        settings.spacing = options.spacing;
    }
    const Job job = job_for(options.job, options.program, options.after);
    settings.max_engagement = options.max_engagement;
    settings.engagement = asks_for_engagement(options, job);
    cancellation::set_work("cutting " + options.program);
    const verify::Verification result =
        verify::verify(job, options.program, settings, ShareProgress{"cutting"});
    write_output(job, result, options.output);
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
        "The exit status is 1 if a bound of the job is broken:\n"
        "  floor_tolerance (gouge) and plan_tolerance (walls);\n"
        "  scallop, on 99 % of what the tools reach; the rest may keep scallop + floor_tolerance;\n"
        "  a rapid move cuts stock; flutes, shank or holder cut or touch it (docs/job_file.md).\n"
        "Engagement is measured with --stats, --engagement-picture or --max-engagement, or if an\n"
        "operation has max_engagement. docs/stats.md explains the figures.");
    auto options = std::make_shared<VerifyOptions>();
    command->add_option("JOB", options->job, "job file (TOML)")->required();
    command->add_option("PROGRAM", options->program, "G-code")->required();
    add_after_option(*command, options->after);
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
    command->add_option("--engagement-picture", options->output.engagement_picture,
                        "picture to write (SVG): the path from above, coloured by engagement");
    command
        ->add_option("--max-engagement", options->max_engagement,
                     "degrees, for over_engagement_mm; default: that of the job's operations")
        ->check(refusal_of_engagement)
        ->type_name("DEGREES");
    add_resource_options(*command, options->resources);
    run_when_called(*command, work, options, run_verify);
}

}  // namespace cusp::cli
