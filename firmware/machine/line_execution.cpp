// Lines: begun, waited for and answered.
#include "firmware/machine/line_execution.hpp"

namespace cusp::machine {

LineEvent LineExecution::step(bool drives_ready) noexcept
{
    if (task_ == Task::kNone) {
        return startup_.over() ? read() : next_startup_line();
    }
    const bool may_move = task_ == Task::kActions || task_ == Task::kHome;
    return may_move && !drives_ready ? LineEvent::kNothing : go_on();
}

LineEvent LineExecution::read() noexcept
{
    std::string_view text;
    switch (core_.lines.read(text)) {
        case LineDialogue::Progress::kNothing:
            return LineEvent::kNothing;
        case LineDialogue::Progress::kWorked:
            return LineEvent::kWorked;
        case LineDialogue::Progress::kLine:
            break;
    }
    ending_ = Ending::kAnswer;
    core_.keeper.begin_line();
    execute_text(text);
    return worked();
}

void LineExecution::execute_text(std::string_view text) noexcept
{
    if (text.empty()) {
        finish(std::nullopt);
    } else if (text[0] == '$') {
        execute_command(text);
    } else if (core_.system.is(State::kAlarm) || core_.system.is(State::kJog) ||
               core_.lines.cancelled_in_jog()) {
        finish(Error::kSystemGcLock);
    } else {
        execute_gcode(text, Ending::kAnswer);
    }
}

void LineExecution::execute_command(std::string_view text) noexcept
{
    using Next = CommandOutcome::Next;
    const CommandOutcome outcome = commands_.perform(text);
    resets_ = outcome.resets;
    switch (outcome.next) {
        case Next::kAnswer:
            finish(outcome.error);
            break;
        case Next::kListing:
            task_ = Task::kListing;
            break;
        case Next::kConfigure:
            task_ = Task::kConfigure;
            break;
        case Next::kFinish:
            task_ = Task::kFinish;
            break;
        case Next::kHome:
            task_ = Task::kHome;
            break;
        case Next::kActions:
            task_ = Task::kActions;
            break;
        case Next::kTryStartupLine:
            execute_gcode(startup_.text(), Ending::kKeepStartupLine);
            break;
        case Next::kCheckedLines:
        case Next::kPlainLines:
            finish(std::nullopt);
            core_.lines.switch_checked(outcome.next == Next::kCheckedLines);
            break;
    }
}

void LineExecution::execute_gcode(std::string_view text, Ending ending) noexcept
{
    ending_ = ending;
    const Status status = actions_.read(text);
    if (status) {
        task_ = Task::kActions;
        return;
    }
    const bool stops = core_.settings().on(Setting::kStopOnError) &&
                       (core_.system.is(State::kRun) || core_.system.is(State::kIdle));
    finish(status.error());
    if (stops) {
        core_.message("Stopped at an error: reset, or cycle start to go on");
        cycle_.hold();
    }
}

void LineExecution::finish(std::optional<Error> error) noexcept
{
    task_ = Task::kNone;
    const Ending ending = ending_;
    ending_ = Ending::kAnswer;
    if (ending == Ending::kStartupLine) {
        (void)core_.replies.character('>').text(startup_.text()).character(':');
    }
    if (ending == Ending::kKeepStartupLine && !error) {
        startup_.keep();
        core_.keeper.want_store();
        task_ = Task::kFinish;
        return;
    }
    core_.lines.answer(error);
    if (ending != Ending::kStartupLine) {
        core_.lines.next();
    }
    cycle_.line_answered();
}

LineEvent LineExecution::worked() noexcept
{
    if (waits() || !resets_) {
        return LineEvent::kWorked;
    }
    resets_ = false;
    return LineEvent::kReset;
}

LineEvent LineExecution::next_startup_line() noexcept
{
    if (startup_.all_run()) {
        startup_.answered();
        finish(std::nullopt);
        return LineEvent::kWorked;
    }
    startup_.advance();
    if (!startup_.text().empty()) {
        execute_gcode(startup_.text(), Ending::kStartupLine);
    }
    return LineEvent::kWorked;
}

LineEvent LineExecution::go_on() noexcept
{
    switch (task_) {
        case Task::kNone:
            break;
        case Task::kActions:
            return step_actions();
        case Task::kHome:
            return step_home();
        case Task::kListing:
            return step_listing();
        case Task::kConfigure:
            return step_configure();
        case Task::kFinish:
            return step_finish();
    }
    return LineEvent::kNothing;
}

LineEvent LineExecution::step_actions() noexcept
{
    switch (actions_.step()) {
        case ActionProgress::kWaits:
            return LineEvent::kNothing;
        case ActionProgress::kDone:
            break;
        case ActionProgress::kLineOver:
            if (actions_.alarm() != Alarm::kNone) {
                alarm_ = actions_.alarm();
                return LineEvent::kProbeAlarm;
            }
            finish_probe();
            break;
        case ActionProgress::kLineFails:
            core_.resynchronise();
            finish(Error::kTravelExceeded);
            break;
        case ActionProgress::kAlarm:
            return raise(actions_.alarm());
    }
    return LineEvent::kWorked;
}

void LineExecution::finish_probe() noexcept
{
    actions_.tell_probe();
    finish(core_.keeper.answer());
}

LineEvent LineExecution::step_home() noexcept
{
    switch (homing_.step()) {
        case Homing::Progress::kWaiting:
            return LineEvent::kNothing;
        case Homing::Progress::kStepped:
            break;
        case Homing::Progress::kFailed:
            return raise(homing_.alarm());
        case Homing::Progress::kFinished:
            task_ = Task::kNone;
            startup_.run_before_answer(homing_.homes_all());
            break;
    }
    return LineEvent::kWorked;
}

LineEvent LineExecution::step_listing() noexcept
{
    if (!reports_.write_line()) {
        finish(std::nullopt);
    }
    return LineEvent::kWorked;
}

LineEvent LineExecution::step_configure() noexcept
{
    if (!core_.motion.settled()) {
        return LineEvent::kNothing;
    }
    core_.reporter.work_offset_changed();
    task_ = Task::kFinish;
    return LineEvent::kConfigure;
}

LineEvent LineExecution::step_finish() noexcept
{
    if (core_.keeper.wants_store()) {
        return LineEvent::kNothing;
    }
    finish(core_.keeper.answer());
    return worked();
}

void LineExecution::cancel_jog() noexcept
{
    if (task_ == Task::kActions && actions_.jogs()) {
        core_.interpreter.discard();
        actions_.drop();
        finish(std::nullopt);
    }
}

void LineExecution::drop() noexcept
{
    task_ = Task::kNone;
    ending_ = Ending::kAnswer;
    resets_ = false;
    actions_.drop();
    startup_.forget();
}

}  // namespace cusp::machine
