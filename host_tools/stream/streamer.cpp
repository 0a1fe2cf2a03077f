// The transfer: greeting, lines and answers, rest, and stopping.
#include "host_tools/stream/streamer.hpp"

#include <algorithm>

namespace cusp::host {
namespace {

using std::chrono::milliseconds;

constexpr char kSoftReset = '\x18';
constexpr milliseconds kPump{20};
// A machine at full speed comes to rest well within this.
constexpr milliseconds kHoldLimit{10'000};
constexpr milliseconds kResetLimit{3000};

std::string name_of(const std::string& file, std::uint64_t line)
{
    return file + ":" + std::to_string(line);
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
    last_heard_ = last_asked_ = Clock::now();
    StreamReport report;
    try {
        greet();
        learn_controller();
        prepare_record();
        if (options_.resume) {
            prepare_resume(program);
        }
        watcher_.ready(facts_);
        sending_ = true;
        if (options_.checked) {
            switch_checks_on();
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

void Streamer::greet()
{
    const auto start = Clock::now();
    send_realtime('?');
    while (statuses_ == 0) {
        pump(kPump);
        if (Clock::now() - start > options_.greeting_limit) {
            throw Ending{StreamOutcome::kNotReady,
                         "no controller answers on this port within " +
                             std::to_string(options_.greeting_limit.count() / 1000) + " s"};
        }
    }
    if (options_.resume) {
        come_to_idle();
        return;
    }
    if (is_state("Alarm")) {
        throw Ending{StreamOutcome::kNotReady,
                     "the controller is in alarm: home it ($H) or unlock it ($X) first"};
    }
    if (!is_state("Idle") && !is_state("Check")) {
        throw Ending{StreamOutcome::kNotReady,
                     "the controller is not idle but in state " + progress_.status.state};
    }
}

// Before a resume: whatever still runs of the program is held, and all modes are the defaults.
void Streamer::come_to_idle()
{
    hold_and_reset();
    stopping_ = false;
    constexpr milliseconds kLastBanner{300};
    const auto start = Clock::now();
    while (Clock::now() - start < kLastBanner) {
        pump(kPump);
    }
    const std::uint64_t before = statuses_;
    send_realtime('?');
    while (statuses_ == before) {
        pump(kPump);
    }
    if (!is_state("Idle") && !is_state("Alarm")) {
        throw Ending{StreamOutcome::kNotReady,
                     "the controller is not idle but in state " + progress_.status.state};
    }
}

void Streamer::learn_controller()
{
    for (const char* command : {"$I", "$$", "$G", "$#"}) {
        ask(command);
    }
    window_.set_capacity(options_.window != 0 ? options_.window
                                              : std::max(facts_.receive_buffer().value_or(0),
                                                         FlowWindow::kGrblBuffer));
}

// A command of the streamer's own, and its answer. A refusal is an answer.
void Streamer::ask(const std::string& command)
{
    // A controller that resets when its port is opened may do so now, and one that checks lines
    // leaves the question unheard: then it is asked again.
    constexpr int kAttempts = 4;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        const std::uint64_t answers = own_answers_;
        const std::uint64_t banners = banners_;
        const auto start = Clock::now();
        window_.clear();
        send_line(0, command);
        while (banners_ == banners && Clock::now() - start < options_.greeting_limit / 2) {
            if (own_answers_ != answers) {
                return;
            }
            pump(kPump);
        }
    }
    throw Ending{StreamOutcome::kNotReady, "the controller answers ? but not " + command};
}

// Homing is answered when it is finished; meanwhile the reports tell that the line lives.
void Streamer::home()
{
    constexpr std::chrono::minutes kHomingLimit{10};
    const std::uint64_t answers = own_answers_;
    const std::uint64_t errors = own_errors_;
    const auto start = Clock::now();
    send_line(0, "$H");
    while (own_answers_ == answers) {
        pump(kPump);
        if (Clock::now() - start > kHomingLimit) {
            throw Ending{StreamOutcome::kNotReady, "homing does not end"};
        }
    }
    if (own_errors_ != errors) {
        throw Ending{StreamOutcome::kAlarm, "homing failed"};
    }
    const std::uint64_t before = statuses_;
    send_realtime('?');
    while (statuses_ == before) {
        pump(kPump);
    }
}

Position Streamer::machine_position() const
{
    const ControllerStatus& status = progress_.status;
    Vec3d at = status.machine_position.value_or(Vec3d{});
    if (!status.machine_position && status.work_position) {
        at = *status.work_position + progress_.work_offset;
    }
    constexpr double kInch = 25.4;
    const bool inches = facts_.settings().on(machine::Setting::kReportInches);
    return to_position(inches ? at * kInch : at);
}

void Streamer::prepare_record()
{
    record_.start = {machine_position(), facts_.modal(), facts_.parameters(),
                     facts_.settings().value(machine::Setting::kPathTolerance)};
    executed_.begin_at(1);
}

// Where and how the program goes on.
void Streamer::prepare_resume(ProgramLines& program)
{
    const StreamResume& resume = *options_.resume;
    const bool homes = is_state("Alarm");
    if (homes && !facts_.settings().on(machine::Setting::kHoming)) {
        throw Ending{StreamOutcome::kNotReady,
                     "the controller is in alarm and can't home ($22=0): see that its position is "
                     "true and unlock it ($X) first"};
    }
    const Vec3d gone = to_millimetres(resume.record.last_seen);
    constexpr double kNear = 0.01;
    const bool lost = !homes && machine_position() == Position{} && norm(gone) > kNear;
    const bool goes_on = resume.confirm(facts_, machine_position(), homes, lost);
    last_heard_ = last_asked_ = Clock::now();
    if (!goes_on) {
        throw Ending{StreamOutcome::kNotReady, "not resumed"};
    }
    if (homes) {
        home();
    }
    for (const std::string& line : resume.approach(facts_, machine_position())) {
        // Under the number of the line that they lead to.
        first_lines_.push_back(
            {0, options_.checked || !options_.numbers ? line : numbered_line(line, resume.line)});
    }
    record_.start = resume.record.start;
    executed_.begin_at(resume.line);
    while (auto line = program.next()) {
        if (line->number >= resume.line) {
            first_lines_.push_back(std::move(*line));
            break;
        }
        checks_.add(*line);
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
        checks_.add(*line);
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

// $CRC=1 itself is not guarded: where it is damaged it is answered with an error, or not at all.
void Streamer::switch_checks_on()
{
    constexpr int kAttempts = 20;
    constexpr milliseconds kWait{300};
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        window_.clear();
        const std::uint64_t answers = own_answers_;
        const std::uint64_t errors = own_errors_;
        const auto start = Clock::now();
        send_line(0, "$CRC=1");
        while (own_answers_ == answers && Clock::now() - start < kWait) {
            pump(kPump);
        }
        if (own_answers_ != answers && own_errors_ == errors) {
            window_.clear();
            checked_.emplace(window_.capacity());
            return;
        }
    }
    throw Ending{StreamOutcome::kNotReady, "the controller does not know checked lines ($CRC=1)"};
}

// A transfer that was cut off has left lines checked: the refusal tells the number that ends it.
void Streamer::leave_checks(const std::string& refusal)
{
    const auto number = refused_number(refusal);
    if (number) {
        window_.clear();
        outgoing_ += checked_line(*number, "$CRC=0") + "\n";
        send_waiting();
    }
}

void Streamer::send_checked_program(ProgramLines& program)
{
    auto line = next_line(program);
    while (line || !checked_->empty()) {
        while (line && checked_->has_room()) {
            checked_->add(line->number, line->text);
            progress_.lines_sent += line->number != 0 ? 1U : 0U;
            progress_.sent_fraction = program.progress();
            line = next_line(program);
        }
        while (outgoing_.empty()) {
            const auto wire = checked_->next(Clock::now());
            if (!wire) {
                break;
            }
            outgoing_ += *wire;
            send_waiting();
        }
        pump(milliseconds{5});
        progress_.lines_resent = checked_->resent();
    }
}

void Streamer::wait_for_rest()
{
    // The second of two idle reports was asked for after the last answer.
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
    window_.sent(number, text.size());
    outgoing_ += text;
    if (number != 0) {
        ++progress_.lines_sent;
    }
    send_waiting();
}

void Streamer::send_realtime(char byte)
{
    // On a checked line all but the question count at their third repetition; whoever sent before
    // may have left lines checked.
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
    if (!bytes.empty()) {
        last_heard_ = Clock::now();
    }
    for (const char byte : bytes) {
        if (byte == '\n') {
            std::string line;
            line.swap(incoming_);
            take_line(line);
        } else if (byte != '\r') {
            incoming_.push_back(byte);
        }
    }
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

void Streamer::check_silence()
{
    const auto silence = Clock::now() - last_heard_;
    if (silence > options_.silence_limit && statuses_ > 0) {
        throw LinkLost{
            "nothing heard for " +
            std::to_string(std::chrono::duration_cast<milliseconds>(silence).count() / 1000) +
            " s"};
    }
}

void Streamer::take_line(const std::string& line)
{
    if (checked_) {
        take_checked(line);
    } else if (line.rfind("resend ", 0) == 0) {
        leave_checks(line);
    }
    const Answer answer = parse_answer(line);
    switch (answer.kind) {
        case AnswerKind::kStatus:
            take_status(answer.status);
            break;
        case AnswerKind::kOk:
        case AnswerKind::kError:
            take_answer(answer);
            break;
        case AnswerKind::kAlarm:
            if (!stopping_) {
                throw Ending{StreamOutcome::kAlarm, "ALARM:" + std::to_string(answer.code) + ": " +
                                                        std::string{alarm_text(answer.code)}};
            }
            break;
        case AnswerKind::kBanner:
            ++banners_;
            if (!stopping_ && sending_) {
                throw Ending{
                    StreamOutcome::kLinkLost,
                    "the controller has started anew: its power failed or somebody reset it"};
            }
            window_.clear();
            break;
        case AnswerKind::kMessage:
            if (answer.text.rfind("MSG:", 0) == 0) {
                watcher_.notice(answer.text.substr(4));
            }
            facts_.take(line);
            break;
        case AnswerKind::kOther:
            facts_.take(line);
            break;
    }
}

void Streamer::take_status(const ControllerStatus& status)
{
    const bool was_held = is_state("Hold");
    auto line = status.line ? status.line : progress_.status.line;
    if (checked_ && status.line) {
        const std::uint64_t own = checked_->program_line_of(*status.line);
        line = own != 0 ? std::optional{static_cast<std::uint32_t>(own)} : progress_.status.line;
    }
    progress_.status = status;
    progress_.status.line = line;
    progress_.work_offset = status.work_offset.value_or(progress_.work_offset);
    progress_.feed_override = status.feed_override.value_or(progress_.feed_override);
    executed_.blocks_free(static_cast<std::size_t>(std::max(0, status.free_blocks.value_or(0))));
    if (sending_ && line && *line != 0) {
        executed_.reported(*line, Clock::now());
    } else if (sending_ && status.feed.value_or(0.0) > 0.0) {
        executed_.reported_none();
    }
    ++statuses_;
    if (is_state("Hold") && !was_held && !stopping_) {
        watcher_.notice("the controller holds and waits for resume");
    }
    if (is_state("Alarm") && sending_ && !stopping_) {
        throw Ending{StreamOutcome::kAlarm, "the controller is in alarm"};
    }
}

void Streamer::take_answer(const Answer& answer)
{
    const auto number = window_.answered();
    if (!number) {
        return;
    }
    if (*number == 0) {
        ++own_answers_;
        own_errors_ += answer.kind == AnswerKind::kError ? 1 : 0;
    } else {
        ++progress_.lines_answered;
        progress_.line = *number;
        executed_.answered(*number);
    }
    if (answer.kind == AnswerKind::kError) {
        take_error(*number, answer.code);
    }
}

void Streamer::take_error(std::uint64_t line, int code)
{
    if (stopping_ || !sending_) {
        return;
    }
    const std::string where =
        line == 0 ? std::string{"the way back to the work"} : name_of(file_, line);
    throw Ending{StreamOutcome::kError,
                 where + ": error:" + std::to_string(code) + ": " + std::string{error_text(code)}};
}

void Streamer::take_checked(const std::string& line)
{
    const auto verdict = checked_->take(line, Clock::now());
    if (checked_->lapsed() && !stopping_) {
        throw Ending{
            StreamOutcome::kError,
            "the controller has stopped checking lines: somebody else reset it, or it heard "
            "no line for seconds"};
    }
    if (!verdict || verdict->done_lines == 0) {
        return;
    }
    progress_.lines_answered += verdict->done_lines;
    progress_.line = verdict->program_line;
    if (verdict->error != 0) {
        take_error(verdict->program_line, verdict->error);
    }
}

void Streamer::take_key(StreamKey key)
{
    switch (key) {
        case StreamKey::kNone:
            return;
        case StreamKey::kHold:
            return send_realtime('!');
        case StreamKey::kResume:
            return send_realtime('~');
        case StreamKey::kFeedNormal:
            return send_realtime('\x90');
        case StreamKey::kFeedUpTen:
            return send_realtime('\x91');
        case StreamKey::kFeedDownTen:
            return send_realtime('\x92');
        case StreamKey::kFeedUpOne:
            return send_realtime('\x93');
        case StreamKey::kFeedDownOne:
            return send_realtime('\x94');
        case StreamKey::kAbort:
            throw Ending{StreamOutcome::kStopped, "stopped"};
    }
}

}  // namespace cusp::host
