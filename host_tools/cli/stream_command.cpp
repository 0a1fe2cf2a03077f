// `cusp stream`: sends a program to a controller.
#include <fmt/format.h>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cli/cli.hpp"
#include "host_tools/cli/interruption.hpp"
#include "host_tools/controller/simulate/settings_file.hpp"
#include "host_tools/controller/stream/approach.hpp"
#include "host_tools/controller/stream/keyboard.hpp"
#include "host_tools/controller/stream/progress_display.hpp"
#include "host_tools/controller/stream/resume_point.hpp"
#include "host_tools/controller/stream/streamer.hpp"
#include "host_tools/controller/stream/time_table.hpp"
#include "host_tools/controller/stream/transfer_record.hpp"

namespace cusp::cli {

using dialect::ProgramLines;
using simulate::read_settings_file;
using stream::Approach;
using stream::ControllerFacts;
using stream::drop_record;
using stream::Keyboard;
using stream::open_transport;
using stream::ProgressDisplay;
using stream::read_record;
using stream::record_file;
using stream::ResumePoint;
using stream::Streamer;
using stream::StreamKey;
using stream::StreamOptions;
using stream::StreamOutcome;
using stream::StreamProgress;
using stream::StreamReport;
using stream::StreamResume;
using stream::StreamWatcher;
using stream::TimeTable;
using stream::TransferRecord;

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

// Reports on the terminal and asks the user.
class TerminalWatcher : public StreamWatcher {
public:
    explicit TerminalWatcher(const StreamArguments& arguments) : arguments_{arguments} {}

    // The estimate of the time left needs the controller's own settings.
    void ready(const ControllerFacts& facts) override
    {
        if (!arguments_.no_estimate) {
            const auto settings = arguments_.settings_file.empty()
                                      ? facts.settings()
                                      : read_settings_file(arguments_.settings_file);
            times_.emplace(arguments_.program, settings);
        }
        keyboard_.emplace();
        if (keyboard_->is_terminal()) {
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
        if (progress.done) {
            fraction = 1.0;
            left = 0.0;
        }
        display_.show(progress, fraction, left);
    }
    void notice(const std::string& text) override { display_.say(text); }
    StreamKey key() override { return keyboard_ ? keyboard_->read() : StreamKey::kNone; }
    void finish() { display_.finish(); }

private:
    const StreamArguments& arguments_;
    std::optional<Keyboard> keyboard_;
    ProgressDisplay display_{stdout};
    std::optional<TimeTable> times_;
};

int status_of(StreamOutcome outcome)
{
    return outcome == StreamOutcome::kDone ? kDone : kFoundWrong;
}

// The record of the interrupted transfer, or one for the given line number.
TransferRecord record_to_resume(const StreamArguments& arguments)
{
    const auto kept = read_record(arguments.program);
    if (!kept && arguments.resume_line == 0) {
        throw InputError{fmt::format(
            "{}: no interrupted transfer is recorded in {}; name the line: --resume-line N",
            arguments.program, record_file(arguments.program))};
    }
    TransferRecord record = kept.value_or(TransferRecord{});
    if (arguments.resume_line != 0) {
        record.executed_line = arguments.resume_line;
        record.checked_line = 0;
    }
    return record;
}

bool says_yes()
{
    fmt::print("resume? [y/N] ");
    std::fflush(stdout);
    std::string answer;
    std::getline(std::cin, answer);
    return answer == "y" || answer == "Y" || answer == "yes";
}

class ResumeDialogue {
public:
    ResumeDialogue(const StreamArguments& arguments, const TransferRecord& record)
        : arguments_{arguments},
          record_{record},
          point_{find_resume_point(arguments.program, record)}
    {
    }

    StreamResume resume()
    {
        return {record_, point_.line,
                [this](const ControllerFacts& facts, Position machine, bool homes, bool lost) {
                    return confirm(facts, machine, homes, lost);
                },
                [this](const ControllerFacts& facts, Position machine) {
                    return approach(facts, machine).lines;
                }};
    }

private:
    Approach approach(const ControllerFacts& facts, Position machine) const
    {
        return make_approach(point_, record_.start.parameters, facts.parameters(), machine,
                             arguments_.safe_z);
    }

    bool confirm(const ControllerFacts& facts, Position machine, bool homes, bool lost) const
    {
        const Approach way = approach(facts, machine);
        fmt::print("{}:{} was executing; resuming at line {}\n", arguments_.program,
                   record_.executed_line, point_.line);
        if (homes) {
            fmt::print("  homes the machine ($H)\n");
        }
        if (point_.modal.tool != 0) {
            fmt::print("  tool T{} must be in the spindle\n", point_.modal.tool);
        }
        fmt::print("  travels at Z {:.3f} to X {:.3f} Y {:.3f}", way.safe_z, way.point.x,
                   way.point.y);
        if (point_.modal.spindle != gcode::SpindleMode::kOff) {
            fmt::print(", spindle at {:.0f}", point_.modal.spindle_speed);
        }
        if (way.plunges) {
            fmt::print(", goes down to Z {:.3f} at {:.0f} mm/min", way.point.z, way.plunge_feed);
        }
        fmt::print("\n");
        if (lost) {
            fmt::print(
                "  the controller reports 0,0,0: it was probably restarted and has lost the "
                "position "
                "of the tool\n");
        }
        if (arguments_.yes && lost) {
            fmt::print("  check the machine: --yes does not confirm this\n");
            return false;
        }
        return arguments_.yes || says_yes();
    }

    const StreamArguments& arguments_;
    TransferRecord record_;
    ResumePoint point_;
};

void tell_ending(const StreamArguments& arguments, const StreamReport& report)
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
    ProgramLines program{arguments.program};
    StreamOptions options;
    options.window = arguments.window;
    options.checked = arguments.checked;
    options.numbers = !arguments.no_numbers;
    std::optional<ResumeDialogue> dialogue;
    if (arguments.resumes()) {
        dialogue.emplace(arguments, record_to_resume(arguments));
        options.resume = dialogue->resume();
    }
    TerminalWatcher watcher{arguments};
    bool kept = true;
    options.keep = [&](const TransferRecord& record) {
        if (kept && !write_record(arguments.program, record)) {
            watcher.notice("can't write " + record_file(arguments.program) +
                           ": this transfer can only be resumed with --resume-line");
            kept = false;
        }
    };
    const auto transport = open_transport(arguments.port, arguments.baud);
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
    if (report.outcome == StreamOutcome::kDone) {
        drop_record(arguments.program);
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
    command->footer(std::string{Keyboard::legend()} +
                    "\nCtrl-C holds, then resets; twice resets immediately.\n"
                    "Exit status: 0 done; 1 stopped, refused, alarm or link lost; 2 invalid call.");
    run_when_called(*command, work, arguments, run_stream);
}

}  // namespace cusp::cli
