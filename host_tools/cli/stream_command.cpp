// `cusp stream`: sends a program to a controller.
#include <fmt/format.h>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "host_tools/cli/cli.hpp"
#include "host_tools/cli/interruption.hpp"
#include "host_tools/controller/stream/keyboard.hpp"
#include "host_tools/controller/stream/resume_dialogue.hpp"
#include "host_tools/controller/stream/streamer.hpp"
#include "host_tools/controller/stream/terminal_watcher.hpp"
#include "host_tools/controller/stream/transfer_record.hpp"

namespace cusp::cli {

using stream::StreamOutcome;

namespace {

struct StreamArguments {
    std::string port;
    std::string program;
    std::string settings_file;
    int baud{115200};
    std::size_t window{0};
    bool checked{false};
    bool no_estimate{false};
    bool no_numbers{false};
    bool resume{false};
    std::uint64_t resume_line{0};
    std::optional<double> safe_z;
    bool yes{false};

    bool resumes() const { return resume || resume_line != 0; }
};

int status_of(StreamOutcome outcome)
{
    return outcome == StreamOutcome::kDone ? kDone : kFoundWrong;
}

bool says_yes()
{
    fmt::print("resume? [y/N] ");
    std::fflush(stdout);
    std::string answer;
    std::getline(std::cin, answer);
    return answer == "y" || answer == "Y" || answer == "yes";
}

bool confirms(const std::string& way, bool lost, bool yes)
{
    fmt::print("{}", way);
    if (yes && lost) {
        fmt::print("  check the machine: --yes does not confirm this\n");
        return false;
    }
    return yes || says_yes();
}

void tell_ending(const StreamArguments& arguments, const stream::StreamReport& report)
{
    fmt::print(stderr, "cusp stream: {}\n", report.text);
    if (!report.record) {
        return;
    }
    fmt::print(stderr,
               "the last line answered is {}:{}; the tool had reached line {}\n"
               "to resume there: cusp stream {} {} --resume\n",
               arguments.program, report.progress.line, report.record->executed_line,
               arguments.port, arguments.program);
}

int run_stream(const StreamArguments& arguments)
{
    dialect::ProgramLines program{arguments.program};
    stream::StreamOptions options;
    options.window = arguments.window;
    options.checked = arguments.checked;
    options.numbers = !arguments.no_numbers;
    std::optional<stream::ResumeDialogue> dialogue;
    if (arguments.resumes()) {
        dialogue.emplace(arguments.program, arguments.resume_line, arguments.safe_z,
                         [yes = arguments.yes](const std::string& way, bool lost) {
                             return confirms(way, lost, yes);
                         });
        options.resume = dialogue->resume();
    }
    stream::TerminalWatcher watcher{arguments.program, arguments.settings_file,
                                    !arguments.no_estimate};
    bool kept = true;
    options.keep = [&](const stream::TransferRecord& record) {
        if (kept && !write_record(arguments.program, record)) {
            watcher.notice("can't write " + stream::record_file(arguments.program) +
                           ": this transfer can only be resumed with --resume-line");
            kept = false;
        }
    };
    const auto transport = stream::open_transport(arguments.port, arguments.baud);
    stream::Streamer streamer{*transport, watcher, options};
    const stream::StreamReport report = streamer.run(program, count_interruptions());
    watcher.finish();
    const stream::StreamProgress& progress = report.progress;
    fmt::print("{} lines sent, {} answered", progress.lines_sent, progress.lines_answered);
    if (arguments.checked) {
        fmt::print(", {} sent again", progress.lines_resent);
    }
    fmt::print("\n");
    std::fflush(stdout);
    if (report.outcome == StreamOutcome::kDone) {
        stream::drop_record(arguments.program);
    } else {
        tell_ending(arguments, report);
    }
    return status_of(report.outcome);
}

}  // namespace

void add_stream_command(CLI::App& app, Work& work)
{
    CLI::App* command = app.add_subcommand("stream", "send a program to a controller");
    const auto arguments = std::make_shared<StreamArguments>();
    command
        ->add_option(
            "port", arguments->port,
            "Serial device, pseudo-terminal, tcp:HOST:PORT, or usb:NAME: a board on USB by a part\n"
            "of its name, its serial number or VID:PID; usb: alone is the only one there")
        ->required();
    command->add_option("program", arguments->program, "G-code to send")->required();
    command->add_option("--baud", arguments->baud, "Baud rate of a serial device")
        ->capture_default_str();
    command->add_option("--window", arguments->window,
                        "Bytes of the controller's buffer; 0: query it");
    command->add_flag("--checked", arguments->checked,
                      "Number and check every line: damaged or lost lines are sent again");
    command->add_option("--settings", arguments->settings_file,
                        "Settings for the time left (default: the controller's own)");
    command->add_flag("--resume", arguments->resume,
                      "Resume an interrupted transfer, after confirmation");
    command->add_option("--resume-line", arguments->resume_line,
                        "Resume at this line of the file, which the tool had reached");
    command->add_option("--safe-z", arguments->safe_z,
                        "Height of the approach move, mm in the program's coordinates\n"
                        "(default: the highest that the program had reached)");
    command->add_flag("--yes", arguments->yes, "Resume without confirmation");
    command->add_flag("--no-numbers", arguments->no_numbers,
                      "Send the lines without N words (resuming then starts further back)");
    command->add_flag("--no-estimate", arguments->no_estimate, "Do not compute the time left");
    command->footer(std::string{stream::Keyboard::legend()} +
                    "\nCtrl-C holds, then resets; twice resets immediately.\n"
                    "Exit status: 0 done; 1 stopped, refused, alarm or link lost; 2 invalid call.");
    run_when_called(*command, work, arguments, run_stream);
}

}  // namespace cusp::cli
