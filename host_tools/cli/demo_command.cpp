// cusp demo: plans, verifies, simulates and draws the packaged pocket.
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <unistd.h>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/files/program_data.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/plan/plan.hpp"
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/cli/cli.hpp"
#include "host_tools/cli/console_watcher.hpp"
#include "host_tools/cli/share_progress.hpp"
#include "host_tools/controller/simulate/settings_file.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/report/report.hpp"
#include "host_tools/judge/report/run_summary.hpp"
#include "host_tools/judge/verify/verify_statistics.hpp"
#include "host_tools/judge/view/run_page.hpp"

#include "CLI/CLI.hpp"
#include "fmt/format.h"

namespace cusp::cli {

using files::write_text;

namespace {

namespace fs = std::filesystem;

constexpr const char* kJob = "demo/pocket.toml";
constexpr const char* kMill = "demo/mill.settings";

struct DemoOptions {
    std::string out{"cusp-demo"};
    std::string examples;
    bool traces{};
};

// The folder that is given, or that of the examples that come with the program.
fs::path examples_folder(const std::string& given)
{
    std::error_code failed;
    if (!given.empty()) {
        if (!fs::is_regular_file(given / fs::path{kJob}, failed)) {
            throw InputError(fmt::format("--examples {}: holds no {}", given, kJob));
        }
        return given;
    }
    if (const auto found = files::program_data("examples", kJob)) {
        return *found;
    }
    throw InputError(
        fmt::format("no share/cusp/examples/{0} and no examples/{0} in {1} or above: "
                    "name the folder of the examples with --examples DIR",
                    kJob, files::program_folder().string()));
}

// Called before any computation, so that a folder that can't be written is refused immediately.
void make_folder(const fs::path& folder)
{
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (!failed && ::access(folder.c_str(), W_OK | X_OK) != 0) {
        failed = {errno, std::generic_category()};
    }
    if (failed) {
        throw InputError(
            fmt::format("--out {}: can't be written: {}", folder.string(), failed.message()));
    }
}

// Runs the program and writes its page.
simulate::SimulationResult run_with_page(const fs::path& folder,
                                         const fs::path& program,
                                         const job::Job& job,
                                         const simulate::SimulationOptions& mill,
                                         const verify::Verification& cut)
{
    view::RunPageOptions options;
    options.simulation = mill;
    options.job = &job;
    options.verification = &cut;
    const view::RunPage page = view::run_page(program, options);
    write_text(folder / "sim.json", statistics_json(page.run));
    write_text(folder / "RUN.html", page.html);
    return page.run;
}

int run_demo(const DemoOptions& options)
{
    const fs::path examples = examples_folder(options.examples);
    job::Job job = import::read_job(examples / kJob, strategies::all());
    simulate::SimulationOptions mill;
    mill.settings = simulate::read_settings_file(examples / kMill);
    const fs::path out = options.out;
    make_folder(out);

    const fs::path program = out / "pocket.ngc";
    ConsoleWatcher watcher{stdout};
    plan::PlanOptions plan_options;
    plan_options.title = "job " + job.file;
    const plan::PlannedProgram plan = plan::plan_job(job, plan_options, watcher);
    write_text(program, plan.gcode);
    write_text(out / "plan.json", statistics_json(job, plan));
    verify::VerifySettings settings;
    settings.engagement = true;
    const verify::Verification cut =
        verify::verify(job, program, settings, ShareProgress{"cutting"});
    write_text(out / "verify.json", statistics_json(cut));
    write_text(out / "path.svg", report::path_picture(job, cut.program));
    write_text(out / "left.svg", report::left_picture(job, cut));
    write_text(out / "verify.txt", verification_text(cut));
    if (options.traces) {
        mill.vcd_file = out / "pocket.vcd";
        mill.samples_file = out / "samples.csv";
    }
    ShareProgress bar{"running"};
    mill.progress = [&bar](const simulate::SimulationProgress& progress) {
        bar(progress.fraction);
    };
    const simulate::SimulationResult run = run_with_page(out, program, job, mill, cut);
    bar(1.0);

    fmt::print("\nPocket with a curved floor and an island: {}\n\n{}", job.file,
               report::run_summary(plan.operations, run, cut));
    const auto page = files::program_data("studio", "studio.html");
    fmt::print(
        "\nIn {}: pocket.ngc (G-code), path.svg left.svg (pictures),\n"
        "plan.json sim.json verify.json verify.txt (figures){}\n"
        "RUN.html shows the run: any browser opens it\n"
        "cusp studio does all of this in a browser, with a part of your own{}\n",
        out.string(),
        options.traces ? ", pocket.vcd (pulses, for GTKWave), samples.csv (set points)" : "",
        page
            ? fmt::format(";\non any system, this file alone: {}", (*page / "studio.html").string())
            : "");
    std::fflush(stdout);
    fmt::print(stderr, "{}", simulate::faults_text(program, run));
    for (const std::string& broken : cut.broken) {
        fmt::print("broken: {}\n", broken);
    }
    return cut.broken.empty() && run.good() ? kDone : kFoundWrong;
}

}  // namespace

void add_demo_command(CLI::App& app, Work& work)
{
    CLI::App* command =
        app.add_subcommand("demo", "plan, verify, simulate and draw a pocket that comes with cusp");
    command->footer(
        "A flat end mill roughs the pocket in layers, a ball finishes it: one program, two tools.\n"
        "The exit status is 1 if a bound of the job is broken, or the run ends early.");
    auto options = std::make_shared<DemoOptions>();
    command->add_option("--out", options->out, "folder of the files to write")
        ->capture_default_str();
    command->add_option("--examples", options->examples,
                        "folder of the examples (default: those of this program)");
    command->add_flag("--traces", options->traces,
                      "also write every pulse (pocket.vcd) and set point (samples.csv): 470 MB");
    run_when_called(*command, work, options, run_demo);
}

}  // namespace cusp::cli
