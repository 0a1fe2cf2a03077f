// The transfer: lines, end of motion, and stopping.
#include "host_tools/controller/stream/streamer.hpp"

#include <algorithm>

#include "firmware/gcode/command.hpp"
#include "firmware/gcode/decimal.hpp"

namespace cusp::stream {

using dialect::numbered_line;
using dialect::ProgramLine;
using dialect::ProgramLines;

namespace {

using std::chrono::milliseconds;

constexpr char kSoftReset = '\x18';
// A machine at full speed stops well within this.
constexpr milliseconds kHoldLimit{10'000};
constexpr milliseconds kResetLimit{3000};

// Seconds of the G4 of a line; 0 if it has none.
milliseconds dwell_of(const std::string& words)
{
    constexpr double kLongest = 1e6;  // s
    gcode::Command command;
    if (!gcode::read_command(words, gcode::ModalState{}, command) ||
        command.non_modal != gcode::NonModal::kDwell || !command.has('P')) {
        return milliseconds{0};
    }
    const double seconds = std::clamp(gcode::to_double(command.value('P')), 0.0, kLongest);
    return milliseconds{static_cast<std::int64_t>(1000 * seconds)};
}

}  // namespace

Streamer::Streamer(Transport& transport, StreamWatcher& watcher, const StreamOptions& options)
    : transport_{transport}, watcher_{watcher}, options_{options}
{
}

StreamReport Streamer::run(ProgramLines& program, const std::atomic<int>& stop)
{
    stop_ = &stop;
    file_ = program.file();
    last_heard_ = last_asked_ = last_answered_ = Clock::now();
    StreamReport report;
    try {
        greet();
        // Checked lines: unchecked commands are not sent, since damage could turn one into another.
        if (options_.checked) {
            switch_checks_on();
        }
        learn_controller();
        prepare_record();
        if (options_.resume) {
            prepare_resume(program);
        }
        watcher_.ready(facts_);
        sending_ = true;
        if (options_.checked) {
            send_checked_program(program);
        } else {
            send_program(program);
        }
        wait_for_rest();
    } catch (const Ending& ending) {
        report.outcome = ending.outcome;
        report.text = ending.text;
        if (ending.outcome == StreamOutcome::kError || ending.outcome == StreamOutcome::kStopped) {
            try {
                hold_and_reset();
            } catch (const Ending& worse) {
                report.text += "; then " + worse.text;
            } catch (const LinkLost& lost) {
                report.text += std::string{"; then the link was lost: "} + lost.what();
            }
        }
    } catch (const LinkLost& lost) {
        report.outcome = StreamOutcome::kLinkLost;
        report.text = std::string{"the link is lost: "} + lost.what();
    }
    progress_.done = report.outcome == StreamOutcome::kDone;
    report.progress = progress_;
    if (sending_) {
        watcher_.progress(progress_);
        keep_record(report.text);
        report.record = record_;
    }
    return report;
}

void Streamer::send_checked_lines()
{
    while (outgoing_.empty()) {
        const auto wire = checked_->next(Clock::now());
        if (!wire) {
            return;
        }
        outgoing_ += *wire;
        send_waiting();
    }
}

std::optional<ProgramLine> Streamer::next_line(ProgramLines& program)
{
    std::optional<ProgramLine> line;
    if (first_lines_.empty()) {
        line = program.next();
    } else {
        line = std::move(first_lines_.front());
        first_lines_.pop_front();
    }
    if (line && line->number != 0) {
        refuse_realtime_byte(*line);
        checks_.add(*line);
        dwell_ = std::max(dwell_, dwell_of(line->text));
    }
    return line;
}

void Streamer::keep_record(const std::string& ending)
{
    record_.executed_line = executed_.line();
    record_.last_seen = machine_position();
    const ProgramChecks::Mark mark = checks_.before(record_.executed_line);
    record_.checked_line = mark.line;
    record_.crc = mark.crc;
    record_.ending = ending;
    last_kept_ = Clock::now();
    if (options_.keep) {
        options_.keep(record_);
    }
}

void Streamer::send_program(ProgramLines& program)
{
    const auto numbered = [&] {
        auto line = next_line(program);
        if (line && line->number != 0 && options_.numbers) {
            line->text = numbered_line(line->text, line->number);
        }
        return line;
    };
    auto line = numbered();
    while (line || !window_.empty()) {
        while (line && outgoing_.empty() && window_.fits(line->text.size() + 1)) {
            send_line(line->number, line->text);
            progress_.sent_fraction = program.progress();
            line = numbered();
        }
        pump(kPump);
    }
}

void Streamer::send_checked_program(ProgramLines& program)
{
    auto line = next_line(program);
    while (line || !checked_->empty()) {
        while (line && checked_->has_room()) {
            if (checked_->empty()) {
                note_answer();
            }
            checked_->add(line->number, line->text);
            progress_.lines_sent += line->number != 0 ? 1U : 0U;
            progress_.sent_fraction = program.progress();
            line = next_line(program);
        }
        send_checked_lines();
        pump(milliseconds{5});
        progress_.lines_resent = checked_->resent();
    }
}

void Streamer::wait_for_rest()
{
    // The second of two idle reports was requested after the last answer.
    for (int idle = 0; idle < 2;) {
        const std::uint64_t before = statuses_;
        send_realtime('?');
        last_asked_ = Clock::now();
        while (statuses_ == before) {
            pump(kPump);
        }
        const bool rests = is_state("Idle") || is_state("Check");
        idle = rests ? idle + 1 : 0;
        if (!rests) {
            pump(milliseconds{50});
        }
    }
}

void Streamer::hold_and_reset()
{
    stopping_ = true;
    outgoing_.clear();
    send_realtime('!');
    const auto start = Clock::now();
    const auto at_rest = [this] {
        return (is_state("Hold") && progress_.status.substate == 0) || is_state("Idle") ||
               is_state("Alarm") || is_state("Check") || is_state("Sleep");
    };
    const std::uint64_t before = statuses_;
    while ((statuses_ < before + 2 || !at_rest()) && stop_->load() < 2 &&
           Clock::now() - start < kHoldLimit) {
        pump(kPump);
    }
    const std::uint64_t banners = banners_;
    send_realtime(kSoftReset);
    window_.clear();
    const auto reset = Clock::now();
    while (banners_ == banners && Clock::now() - reset < kResetLimit) {
        pump(kPump);
    }
}

void Streamer::send_waiting()
{
    if (!outgoing_.empty()) {
        outgoing_.erase(0, transport_.write(outgoing_));
    }
}

void Streamer::send_line(std::uint64_t number, std::string text)
{
    text.push_back('\n');
    if (window_.empty()) {
        note_answer();
    }
    window_.sent(number, text.size());
    outgoing_ += text;
    if (number != 0) {
        ++progress_.lines_sent;
    }
    send_waiting();
}

void Streamer::send_realtime(char byte)
{
    // With checked lines a realtime byte takes effect at its third repetition, except '?'. An
    // earlier sender may have left checking on.
    const bool repeats = (checked_ || !sending_) && byte != '?';
    std::string bytes(repeats ? 3 : 1, byte);
    const auto start = Clock::now();
    while (!bytes.empty()) {
        bytes.erase(0, transport_.write(bytes));
        if (Clock::now() - start > options_.silence_limit) {
            throw LinkLost{"the line takes no bytes"};
        }
    }
}

void Streamer::pump(milliseconds wait)
{
    send_waiting();
    const std::string bytes = transport_.read(outgoing_.empty() ? wait : milliseconds{1});
    take_bytes(bytes);
    if (Clock::now() - last_asked_ > options_.status_interval) {
        last_asked_ = Clock::now();
        const char question = '?';
        transport_.write({&question, 1});
        if (sending_) {
            watcher_.progress(progress_);
        }
    }
    check_silence();
    constexpr std::chrono::seconds kKeepInterval{1};
    if (sending_ && Clock::now() - last_kept_ > kKeepInterval) {
        keep_record("");
    }
    if (!stopping_) {
        take_key(watcher_.key());
        if (stop_->load() != 0) {
            throw Ending{StreamOutcome::kStopped, "stopped"};
        }
    }
}

}  // namespace cusp::stream
