// cusp view: a run as one page for any browser.
#include <memory>

#include "host_tools/cli/commands.hpp"
#include "host_tools/cli/interruption.hpp"
#include "host_tools/cli/share_progress.hpp"
#include "host_tools/files/files.hpp"
#include "host_tools/import/import.hpp"
#include "host_tools/input_error/input_error.hpp"
#include "host_tools/job/job.hpp"
#include "host_tools/simulate/settings_file.hpp"
#include "host_tools/view/run_page.hpp"

#include "CLI/CLI.hpp"
#include "fmt/format.h"

namespace cusp::cli {

using files::write_text;
using import::read_job;
using job::Job;
using simulate::read_settings_file;
using view::run_page;
using view::RunPage;
using view::RunPageOptions;

namespace {

struct ViewArguments {
    std::string program;
    std::string job_file;
    std::string settings_file;
    std::string page;
};

RunPage page_of(const ViewArguments& arguments)
{
    RunPageOptions options;
    if (!arguments.settings_file.empty()) {
        options.settings = read_settings_file(arguments.settings_file);
    }
    std::optional<Job> job;
    if (!arguments.job_file.empty()) {
        job = read_job(arguments.job_file);
        options.job = &*job;
    }
    constexpr double kQuiet = 2.0;
    ShareProgress cutting{"cutting", kQuiet};
    ShareProgress running{"running", kQuiet};
    options.progress = [&](const char* what, double share) {
        (what[0] == 'c' ? cutting : running)(share);
    };
    const std::atomic<int>& stops = count_interruptions();
    options.stop = [&stops] {
        return stops.load() > 0;
    };
    return run_page(arguments.program, options);
}

int run_view(const ViewArguments& arguments)
{
    const RunPage page = page_of(arguments);
    write_text(arguments.page, page.html);
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
        "The page is one file: any browser opens it, without a network.\n"
        "Exit status 1 where the run ends early, lines are refused, or a bound of the job does "
        "not\n"
        "hold; the page is written all the same.");
    auto arguments = std::make_shared<ViewArguments>();
    command->add_option("PROGRAM", arguments->program, "G-code, of cusp or any other source")
        ->required();
    command->add_option("--job", arguments->job_file,
                        "job file (TOML): part, stock, tools, and what the part is held against");
    command->add_option("--settings", arguments->settings_file, "settings of the machine");
    command->add_option("-o,--output", arguments->page, "page to write (HTML)")->required();
    command->callback([&work, arguments] {
        work = [arguments] {
            return run_view(*arguments);
        };
    });
}

}  // namespace cusp::cli
