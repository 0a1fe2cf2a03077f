// `cusp stream`: sends a program to a controller.
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <string>

#include "host_tools/cli/commands.hpp"
#include "host_tools/cli/interruption.hpp"
#include "host_tools/simulate/settings_file.hpp"
#include "host_tools/stream/keyboard.hpp"
#include "host_tools/stream/progress_display.hpp"
#include "host_tools/stream/streamer.hpp"
#include "host_tools/stream/time_table.hpp"

namespace cusp::host {
namespace {

struct StreamArguments {
    std::string port;
    std::string program;
    std::string settings_file;
    int baud{115200};
    std::size_t window{0};
    bool checked{false};
    bool no_estimate{false};
};

// The person at the terminal.
class TerminalWatcher : public StreamWatcher {
public:
    explicit TerminalWatcher(const StreamArguments& arguments)
    {
        if (!arguments.no_estimate) {
            const auto settings = arguments.settings_file.empty()
                                      ? machine::Settings{}
                                      : read_settings_file(arguments.settings_file);
            times_.emplace(arguments.program, settings);
        }
        if (keyboard_.is_terminal()) {
            display_.say(Keyboard::legend());
        }
    }

    void progress(const StreamProgress& progress) override
    {
        double fraction = progress.sent_fraction;
        std::optional<double> left;
        const std::uint64_t line =
            progress.status.line.value_or(0) != 0 ? *progress.status.line : progress.line;
        if (const auto times = times_ ? times_->at_line(line) : std::nullopt) {
            fraction = times->total_s > 0.0 ? times->done_s / times->total_s : fraction;
            left = (times->total_s - times->done_s) * 100.0 / progress.feed_override;
        }
        display_.show(progress, fraction, left);
    }
    void notice(const std::string& text) override { display_.say(text); }
    StreamKey key() override { return keyboard_.read(); }
    void finish() { display_.finish(); }

private:
    Keyboard keyboard_;
    ProgressDisplay display_{stdout};
    std::optional<TimeTable> times_;
};

int status_of(StreamOutcome outcome)
{
    return outcome == StreamOutcome::kDone ? kDone : kFoundWrong;
}

int run_stream(const StreamArguments& arguments)
{
    ProgramLines program{arguments.program};
    const auto transport = open_transport(arguments.port, arguments.baud);
    StreamOptions options;
    options.window = arguments.window;
    options.checked = arguments.checked;
    TerminalWatcher watcher{arguments};
    Streamer streamer{*transport, watcher, options};
    const StreamReport report = streamer.run(program, count_interruptions());
    watcher.finish();
    const StreamProgress& progress = report.progress;
    fmt::print("{} lines sent, {} answered", progress.lines_sent, progress.lines_answered);
    if (arguments.checked) {
        fmt::print(", {} sent again", progress.lines_resent);
    }
    fmt::print("\n");
    std::fflush(stdout);
    if (report.outcome != StreamOutcome::kDone) {
        fmt::print(stderr, "cusp stream: {}\n", report.text);
        if (progress.lines_sent > 0) {
            fmt::print(stderr,
                       "the last line answered is {}:{}; the last one seen executing is {}\n",
                       arguments.program, progress.line,
                       report.resume_line == 0 ? "unknown" : std::to_string(report.resume_line));
        }
    }
    return status_of(report.outcome);
}

}  // namespace

void add_stream_command(CLI::App& app, Work& work)
{
    CLI::App* command = app.add_subcommand("stream", "Send a program to a controller");
    const auto arguments = std::make_shared<StreamArguments>();
    command->add_option("port", arguments->port, "Serial device, pseudo-terminal, or tcp:HOST:PORT")
        ->required();
    command->add_option("program", arguments->program, "G-code to send")->required();
    command->add_option("--baud", arguments->baud, "Of a serial device")->capture_default_str();
    command->add_option("--window", arguments->window,
                        "Bytes of the controller's buffer; 0: ask it");
    command->add_flag("--checked", arguments->checked,
                      "Number and check every line: nothing damaged is cut, nothing is lost");
    command->add_option("--settings", arguments->settings_file,
                        "The controller's settings, for the time left");
    command->add_flag("--no-estimate", arguments->no_estimate, "Do not compute the time left");
    command->footer(
        std::string{Keyboard::legend()} +
        "\nCtrl-C holds, then resets; twice resets at once.\n"
        "Exit status: 0 done; 1 stopped, refused, alarm or link lost; 2 unusable call.");
    command->callback([arguments, &work] {
        work = [arguments] {
            return run_stream(*arguments);
        };
    });
}

}  // namespace cusp::host
