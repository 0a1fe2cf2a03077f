// cusp view: a run as one page for any browser.
#include <memory>
#include <string>
#include <vector>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cli/cli.hpp"
#include "host_tools/cli/interruption.hpp"
#include "host_tools/cli/program_job.hpp"
#include "host_tools/cli/share_progress.hpp"
#include "host_tools/controller/simulate/settings_file.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/view/page_still.hpp"
#include "host_tools/judge/view/page_text.hpp"
#include "host_tools/judge/view/run_page.hpp"

#include "CLI/CLI.hpp"
#include "fmt/format.h"

namespace cusp::cli {

using files::write_text;

namespace {

struct ViewArguments {
    std::string program;
    std::string job_file;
    std::vector<std::string> after;
    std::string settings_file;
    std::string page;
    bool playground{false};
    std::string still;
};

view::RunPage page_of(const ViewArguments& arguments)
{
    view::RunPageOptions options;
    options.simulation.sums_edges = false;
    if (!arguments.settings_file.empty()) {
        options.simulation.settings = simulate::read_settings_file(arguments.settings_file);
    }
    std::optional<job::Job> job;
    if (!arguments.job_file.empty()) {
        job = job_for(arguments.job_file, arguments.program, arguments.after);
        options.job = &*job;
    }
    constexpr double kQuiet = 2.0;
    ShareProgress cutting{"cutting", kQuiet};
    ShareProgress running{"running", kQuiet};
    options.verifying = cutting;
    options.simulation.progress = [&running](const simulate::SimulationProgress& progress) {
        running(progress.fraction);
    };
    options.simulation.stop = was_interrupted();
    return view::run_page(arguments.program, options);
}

int write_playground(const ViewArguments& arguments)
{
    if (!arguments.program.empty() || !arguments.job_file.empty() ||
        !arguments.settings_file.empty() || !arguments.still.empty()) {
        throw InputError{
            "cusp view --playground takes no program, job, settings or still: its page does"};
    }
    const std::string_view page = view::page_text(view::Page::kPlayground);
    if (page.empty() || !view::pages_hold_core()) {
        throw InputError{
            "cusp view --playground has no core to run: cusp was built without npm "
            "(CUSP_VIEW=ON) or without the packages for WebAssembly"};
    }
    write_text(arguments.page, page);
    return kDone;
}

int run_view(const ViewArguments& arguments)
{
    if (arguments.playground) {
        return write_playground(arguments);
    }
    if (arguments.program.empty()) {
        throw InputError{"cusp view needs a program, or --playground"};
    }
    const view::RunPage page = page_of(arguments);
    write_text(arguments.page, page.html);
    write_wanted(arguments.still, [&] { return view::page_still(arguments.page); });
    constexpr double kMegabyte = 1048576.0;
    fmt::print("{}: {} ticks, {:.2f} MB\n{}\n", arguments.page, page.ticks,
               static_cast<double>(page.html.size()) / kMegabyte, page.verdict);
    if (page.refused > 0) {
        fmt::print("{} line{} refused: see the page\n", page.refused, page.refused == 1 ? "" : "s");
    }
    return page.good ? kDone : kFoundWrong;
}

}  // namespace

void add_view_command(CLI::App& app, Work& work)
{
    CLI::App* command =
        app.add_subcommand("view", "write a page that shows a run: path, stock, speeds, limits");
    command->footer(
        "The page is one file, which any browser opens without a network.\n"
        "The exit status is 1 if the run ends early, lines are refused, or a bound of the job is\n"
        "broken; the page is written all the same.");
    auto arguments = std::make_shared<ViewArguments>();
    command->add_option("PROGRAM", arguments->program, "G-code, of cusp or any other source");
    command->add_option("--job", arguments->job_file,
                        "job file (TOML): part, stock, tools and bounds");
    add_after_option(*command, arguments->after);
    command->add_option("--settings", arguments->settings_file, "settings of the machine");
    command->add_flag("--playground", arguments->playground,
                      "write a page that runs any program opened in it on the firmware's core");
    command->add_option("-o,--output", arguments->page, "page to write (HTML)")->required();
    command->add_option("--still", arguments->still,
                        "picture of the scene to write (PNG); needs Chromium");
    run_when_called(*command, work, arguments, run_view);
}

}  // namespace cusp::cli
