// Lines: started and finished.
#include "firmware/machine/machine.hpp"

namespace cusp::machine {

bool Machine::read_lines() noexcept
{
    std::string_view text;
    switch (lines_.read(text)) {
        case LineDialogue::Progress::kNothing:
            return false;
        case LineDialogue::Progress::kWorked:
            return true;
        case LineDialogue::Progress::kLine:
            break;
    }
    ending_ = Ending::kAnswer;
    store_failed_ = false;
    execute_text(text);
    return true;
}

void Machine::execute_text(std::string_view text) noexcept
{
    if (text.empty()) {
        finish_line(std::nullopt);
    } else if (text[0] == '$') {
        execute_command(text);
    } else if (state_ == State::kAlarm || state_ == State::kJog || lines_.cancelled_in_jog()) {
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
    const Status status = interpreter_.execute(text, lines_.line_number());
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
    lines_.answer(error);
    if (ending != Ending::kStartupLine) {
        lines_.next();
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
