// Lines: read, checked, started and answered.
#include "firmware/machine/machine.hpp"

namespace cusp::machine {
namespace {

// Bytes of a slice: more would keep realtime commands waiting.
constexpr unsigned kBytesPerSlice = 64;

}  // namespace

bool Machine::read_lines() noexcept
{
    if (lost_answers_ > 0 || received_.lost()) {
        return report_lost_bytes();
    }
    unsigned taken = 0;
    std::uint8_t byte = 0;
    while (taken < kBytesPerSlice && received_.take(byte)) {
        ++taken;
        if (byte == kLossMark) {
            message("Serial overrun: bytes lost");
            line_.mark_overflow();
            return true;
        }
        if (!line_.started()) {
            line_start_ = received_.taken() - 1;
        }
        if (line_.add(byte)) {
            execute_line();
            return true;
        }
    }
    return taken > 0;
}

// Bytes that found no room: their lines are answered with error 11, one a slice.
bool Machine::report_lost_bytes() noexcept
{
    if (lost_answers_ > 0) {
        --lost_answers_;
        answer(Error::kOverflow);
        return true;
    }
    message("Receive buffer overflow: bytes lost");
    const bool ended = received_.loss_ended_a_line();
    lost_answers_ = received_.take_lost_line_ends();
    line_.begin_line();
    if (!ended) {
        line_.mark_overflow();
    }
    return true;
}

void Machine::execute_line() noexcept
{
    line_number_ = 0;
    ending_ = Ending::kAnswer;
    store_failed_ = false;
    cancelling_ = line_cancelled();
    if (!checked_.on()) {
        if (line_.overflow()) {
            finish_line(Error::kOverflow);
        } else {
            execute_text(line_.line());
        }
        return;
    }
    const std::uint32_t number = checked_.expected();
    if (const std::optional<std::string_view> text = checked_.accept(line_)) {
        line_number_ = number;
        execute_text(*text);
        return;
    }
    if (number == 1 && line_.line() == "$CRC=1") {
        finish_line(std::nullopt);
        return;
    }
    refuse_checked_line();
}

void Machine::execute_text(std::string_view text) noexcept
{
    if (text.empty()) {
        finish_line(std::nullopt);
    } else if (text[0] == '$') {
        execute_command(text);
    } else if (state_ == State::kAlarm || state_ == State::kJog ||
               (line_cancelled() && cancelled_in_jog_)) {
        finish_line(Error::kSystemGcLock);
    } else {
        execute_gcode(text, Ending::kAnswer);
    }
}

void Machine::execute_gcode(std::string_view text, Ending ending) noexcept
{
    ending_ = ending;
    jogging_line_ = false;
    interpreter_.set_tool_change_rule(tool_change_rule());
    const Status status = interpreter_.execute(text, line_number_);
    if (!status) {
        const bool stops = stored_.settings.on(Setting::kStopOnError) &&
                           (state_ == State::kRun || state_ == State::kIdle);
        const Error error = status.error();
        finish_line(error);
        if (stops) {
            message("Stopped at an error: reset, or cycle start to go on");
            feed_hold();
        }
        return;
    }
    task_ = Task::kActions;
}

// True if a jog cancel came after the first byte of this line.
bool Machine::line_cancelled() const noexcept
{
    return cancelling_ && static_cast<std::int32_t>(cancelled_to_ - line_start_) > 0;
}

void Machine::finish_line(std::optional<Error> error) noexcept
{
    task_ = Task::kNone;
    const Ending ending = ending_;
    ending_ = Ending::kAnswer;
    if (ending == Ending::kStartupLine) {
        (void)replies_.character('>').text(startup_text_).character(':');
    }
    if (ending == Ending::kKeepStartupLine && !error) {
        stored_.startup[startup_number_].set(startup_text_);
        store_wanted_ = true;
        task_ = Task::kFinish;
        return;
    }
    answer(error);
    if (ending != Ending::kStartupLine) {
        line_.begin_line();
    }
    if (hold_pending_) {
        hold_pending_ = false;
        hold_program();
    }
    if (reset_after_answer_) {
        reset_after_answer_ = false;
        reset();
    }
}

void Machine::answer(std::optional<Error> error) noexcept
{
    const std::uint32_t start = replies_.place();
    if (error) {
        (void)replies_.text("error:").number(static_cast<std::uint32_t>(*error));
    } else {
        (void)replies_.text("ok");
    }
    if (checked_.on() && line_number_ > 0) {
        (void)replies_.text(" N").number(line_number_);
        protocol::Crc32 crc;
        for (std::uint32_t place = start; place != replies_.place(); ++place) {
            crc.add(replies_.byte_at(place));
        }
        (void)replies_.character('*').hexadecimal(crc.value());
    }
    (void)replies_.end_line();
}

void Machine::refuse_checked_line() noexcept
{
    const std::uint32_t start = replies_.place();
    (void)replies_.text("resend N").number(checked_.expected());
    protocol::Crc32 crc;
    for (std::uint32_t place = start; place != replies_.place(); ++place) {
        crc.add(replies_.byte_at(place));
    }
    (void)replies_.character('*').hexadecimal(crc.value()).end_line();
    line_.begin_line();
}

void Machine::next_startup_line() noexcept
{
    if (startup_next_ == kStartupLineCount) {
        answer_after_startup_ = false;
        finish_line(std::nullopt);
        return;
    }
    const std::string_view text = stored_.startup[startup_next_].view();
    ++startup_next_;
    if (!text.empty()) {
        startup_text_ = text;
        execute_gcode(text, Ending::kStartupLine);
    }
}

}  // namespace cusp::machine
