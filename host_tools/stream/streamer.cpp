// The transfer: greeting, lines and answers, rest, and stopping.
#include "host_tools/stream/streamer.hpp"

#include <algorithm>
#include <charconv>

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

// Bytes of the receive buffer, from `OPT:V,15,128`.
std::size_t buffer_in(std::string_view options)
{
    const std::size_t comma = options.rfind(',');
    std::size_t bytes = 0;
    if (comma != std::string_view::npos) {
        std::from_chars(options.data() + comma + 1, options.data() + options.size(), bytes);
    }
    return bytes;
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
        learn_window();
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
    watcher_.progress(progress_);
    report.progress = progress_;
    report.resume_line = progress_.status.line.value_or(0);
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
    if (is_state("Alarm")) {
        throw Ending{StreamOutcome::kNotReady,
                     "the controller is in alarm: home it ($H) or unlock it ($X) first"};
    }
    if (!is_state("Idle") && !is_state("Check")) {
        throw Ending{StreamOutcome::kNotReady,
                     "the controller is not idle but in state " + progress_.status.state};
    }
}

void Streamer::learn_window()
{
    if (options_.window != 0) {
        window_.set_capacity(options_.window);
        return;
    }
    // A controller that resets when its port is opened may do so now: then the question is lost.
    constexpr int kAttempts = 3;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        const std::uint64_t answers = own_answers_;
        const std::uint64_t banners = banners_;
        const auto start = Clock::now();
        send_line(0, "$I");
        while (banners_ == banners && Clock::now() - start < options_.greeting_limit) {
            if (own_answers_ != answers) {
                return;
            }
            pump(kPump);
        }
    }
    throw Ending{StreamOutcome::kNotReady, "the controller answers ? but not $I"};
}

void Streamer::send_program(ProgramLines& program)
{
    auto line = program.next();
    while (line || !window_.empty()) {
        while (line && outgoing_.empty() && window_.fits(line->text.size() + 1)) {
            send_line(line->number, line->text);
            progress_.sent_fraction = program.progress();
            line = program.next();
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

void Streamer::send_checked_program(ProgramLines& program)
{
    auto line = program.next();
    while (line || !checked_->empty()) {
        while (line && checked_->has_room()) {
            checked_->add(line->number, line->text);
            ++progress_.lines_sent;
            progress_.sent_fraction = program.progress();
            line = program.next();
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
    // On a checked line all but the question count at their third repetition.
    std::string bytes(checked_ && byte != '?' ? 3 : 1, byte);
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
        watcher_.progress(progress_);
    }
    check_silence();
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
            if (!stopping_ && progress_.lines_sent > 0) {
                throw Ending{
                    StreamOutcome::kLinkLost,
                    "the controller has started anew: its power failed or somebody reset it"};
            }
            window_.clear();
            break;
        case AnswerKind::kMessage:
            if (answer.text.rfind("OPT:", 0) == 0) {
                window_.set_capacity(std::max(buffer_in(answer.text), FlowWindow::kGrblBuffer));
            } else if (answer.text.rfind("MSG:", 0) == 0) {
                watcher_.notice(answer.text.substr(4));
            }
            break;
        case AnswerKind::kOther:
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
    ++statuses_;
    if (is_state("Hold") && !was_held && !stopping_) {
        watcher_.notice("the controller holds and waits for resume");
    }
    if (is_state("Alarm") && progress_.lines_sent > 0 && !stopping_) {
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
        return;
    }
    ++progress_.lines_answered;
    progress_.line = *number;
    if (answer.kind == AnswerKind::kError && !stopping_) {
        throw Ending{StreamOutcome::kError, name_of(file_, *number) +
                                                ": error:" + std::to_string(answer.code) + ": " +
                                                std::string{error_text(answer.code)}};
    }
}

void Streamer::take_checked(const std::string& line)
{
    const auto verdict = checked_->take(line, Clock::now());
    if (!verdict || verdict->done_lines == 0) {
        return;
    }
    progress_.lines_answered += verdict->done_lines;
    progress_.line = verdict->program_line;
    if (verdict->error != 0 && !stopping_) {
        throw Ending{StreamOutcome::kError, name_of(file_, verdict->program_line) +
                                                ": error:" + std::to_string(verdict->error) + ": " +
                                                std::string{error_text(verdict->error)}};
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
