// Handles the controller's answers and the user's keys.
#include <algorithm>
#include <filesystem>

#include "host_tools/controller/dialect/line_source.hpp"
#include "host_tools/controller/dialect/refusal.hpp"
#include "host_tools/controller/stream/streamer.hpp"

namespace cusp::stream {

using dialect::alarm_text;
using dialect::Answer;
using dialect::AnswerKind;
using dialect::ControllerStatus;
using dialect::parse_answer;
using dialect::refusal;

namespace {

using std::chrono::milliseconds;

std::string name_of(const std::string& file, std::uint64_t line)
{
    return file + ":" + std::to_string(line);
}

// A line of the program; empty if the file cannot be read again.
std::string text_of(const std::string& file, std::uint64_t line)
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) {
        return "";
    }
    dialect::LineSource source{file};
    while (auto text = source.next()) {
        if (source.line_number() == line) {
            return *text;
        }
    }
    return "";
}

}  // namespace

// Bytes that no answer holds come of a bad line: they are left out. Lines with too many of them, or
// longer than any answer, are no sign that a controller is there.
void Streamer::take_bytes(const std::string& bytes)
{
    constexpr std::size_t kLongestAnswer = 4096;
    for (const char byte : bytes) {
        const bool ends = byte == '\n' || byte == '\r';
        if (ends) {
            if (byte == '\n' && after_return_) {
                after_return_ = false;
                continue;
            }
            std::string line;
            line.swap(incoming_);
            last_heard_ = is_noise_ ? last_heard_ : Clock::now();
            is_noise_ = false;
            take_line(line);
        } else if (byte != '\t' && (byte < ' ' || byte > '~')) {
            is_noise_ = true;
        } else if (incoming_.size() < kLongestAnswer) {
            incoming_.push_back(byte);
        } else {
            is_noise_ = true;
        }
        after_return_ = byte == '\r';
    }
}

void Streamer::refuse_realtime_byte(const dialect::ProgramLine& line)
{
    constexpr int kNoLetter = 1;
    if (dialect::realtime_byte(line.text)) {
        take_error(line.number, kNoLetter);
    }
}

bool Streamer::waits_for_answer() const { return checked_ ? !checked_->empty() : !window_.empty(); }

void Streamer::check_silence()
{
    const auto waiting = Clock::now() - last_answered_;
    if (!stopping_ && is_state("Idle") && waits_for_answer() &&
        waiting > options_.answer_limit + dwell_ + dwell_ / 2) {
        throw LinkLost{
            "the controller is idle and has not answered for " +
            std::to_string(std::chrono::duration_cast<milliseconds>(waiting).count() / 1000) +
            " s: an answer was lost"};
    }
    const auto silence = Clock::now() - last_heard_;
    if (silence > options_.silence_limit && statuses_ > 0) {
        throw LinkLost{
            "nothing heard for " +
            std::to_string(std::chrono::duration_cast<milliseconds>(silence).count() / 1000) +
            " s"};
    }
}

// A status report has a checksum where lines are checked: without it, or an empty text where it is wrong.
std::string Streamer::without_checksum(const std::string& line)
{
    const bool sealed = !line.empty() && line.front() == '<' && line.back() != '>';
    return sealed ? checked_answer(line).value_or("") : line;
}

void Streamer::take_line(const std::string& line)
{
    if (checked_) {
        take_checked(line);
    } else if (line.rfind("resend ", 0) == 0) {
        leave_checks(line);
    }
    const Answer answer = parse_answer(without_checksum(line));
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
                throw Ending{StreamOutcome::kLinkLost,
                             "the controller has restarted: its power failed or it was reset"};
            }
            window_.clear();
            break;
        case AnswerKind::kMessage:
            if (answer.text.rfind("MSG:", 0) == 0) {
                watcher_.notice(answer.text.substr(4));
            }
            take_listing(line);
            break;
        case AnswerKind::kOther:
            take_listing(line);
            break;
    }
}

void Streamer::take_listing(const std::string& line)
{
    if (sending_) {
        return;
    }
    if (checked_) {
        listing_.push_back(line);
    } else {
        facts_.take(line);
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
    if (is_state("Check") && sending_ && !stopping_ && !in_check_mode_) {
        throw Ending{StreamOutcome::kError,
                     "the controller has gone into check mode: nothing is cut"};
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
    note_answer();
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
        line == 0 ? std::string{"the approach to the resume point"} : name_of(file_, line);
    throw Ending{StreamOutcome::kError,
                 where + ": error:" + std::to_string(code) + ": " +
                     refusal(code, line == 0 ? "" : text_of(file_, line)).text};
}

void Streamer::take_checked(const std::string& line)
{
    const auto verdict = checked_->take(line, Clock::now());
    if (checked_->lapsed() && !stopping_) {
        throw Ending{
            StreamOutcome::kError,
            "the controller has stopped checking lines: it was reset from elsewhere, or received "
            "no line for seconds"};
    }
    if (!verdict || verdict->done_lines == 0) {
        return;
    }
    note_answer();
    if (!sending_) {
        own_errors_ += verdict->error != 0 ? 1U : 0U;
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

}  // namespace cusp::stream
