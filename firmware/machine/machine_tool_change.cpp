// M6: a pause, or a tool change at another place with the spindle stopped.
#include "firmware/machine/machine.hpp"

namespace cusp::machine {
namespace {

constexpr std::size_t kPlace = gcode::kCoordinateSystems - 1;  // G59.3

// Machine zero is at the limit switches, which is no place for a tool change: a coordinate system that
// lies there was not set.
bool is_set(Position place) noexcept { return !(place == Position{}); }

}  // namespace

gcode::ToolChangeRule Machine::tool_change_rule() const noexcept
{
    const ToolChangeMode mode = tool_change_mode(stored_.settings);
    const unsigned needed = axes_to_home(mode).bits;
    if (state_ != State::kCheck && (homed_.bits & needed) != needed) {
        return gcode::ToolChangeRule::kNotHomed;
    }
    const bool travels = mode == ToolChangeMode::kAtPlace || mode == ToolChangeMode::kTouchOff;
    if (travels && state_ != State::kCheck &&
        !is_set(interpreter_.parameters().work_offsets[kPlace])) {
        return gcode::ToolChangeRule::kNoPlace;
    }
    return mode == ToolChangeMode::kTouchOff ? gcode::ToolChangeRule::kTouchOff
                                             : gcode::ToolChangeRule::kFree;
}

bool Machine::perform(const gcode::ToolChange& change) noexcept
{
    const ToolChangeMode mode = tool_change_mode(stored_.settings);
    if (state_ == State::kCheck || mode == ToolChangeMode::kIgnore) {
        return true;
    }
    if (!wait_settled()) {
        return false;
    }
    if (mode == ToolChangeMode::kPause) {
        ask_for_tool(change.tool);
        hold_pending_ = true;
    } else {
        start_tool_change(change, mode);
    }
    return true;
}

void Machine::ask_for_tool(unsigned tool) noexcept
{
    (void)replies_.text("[MSG:Tool change T").number(tool);
    (void)replies_.text(": cycle start to go on]").end_line();
}

void Machine::start_tool_change(const gcode::ToolChange& change, ToolChangeMode mode) noexcept
{
    const gcode::Parameters& parameters = interpreter_.parameters();
    const std::int64_t offset = parameters.tool_length_offset_nm;
    const bool known = gcode::ToolTable::holds(change.tool) && parameters.tools.has(change.tool);
    tool_changer_.begin({mode, parameters.work_offsets[kPlace], offset,
                         known ? parameters.tools.length_nm(change.tool) : offset,
                         lines_.line_number() > 0 ? lines_.line_number() : change.line},
                        motion_);
    outputs_.begin_tool_change();
    task_ = Task::kToolChange;
}

bool Machine::step_tool_change() noexcept
{
    const ToolChanger::Progress progress = tool_changer_.step(motion_, stored_.settings);
    // Also between its moves: senders take Idle as the end of the line.
    if (state_ == State::kIdle) {
        state_ = State::kRun;
    }
    switch (progress) {
        case ToolChanger::Progress::kWaiting:
            return false;
        case ToolChanger::Progress::kStepped:
            break;
        case ToolChanger::Progress::kAtChange:
            ask_for_tool(interpreter_.modal().tool);
            feed_hold();
            break;
        case ToolChanger::Progress::kMeasured:
            take_tool_length();
            break;
        case ToolChanger::Progress::kOverPart:
            outputs_.end_tool_change();
            tool_changer_.rest(outputs_.up_at());
            break;
        case ToolChanger::Progress::kFailed:
            raise(tool_changer_.alarm());
            break;
        case ToolChanger::Progress::kFinished:
            task_ = Task::kActions;
            break;
    }
    return true;
}

void Machine::take_tool_length() noexcept
{
    interpreter_.take_tool_length(tool_changer_.length_nm());
    reporter_.work_offset_changed();
    (void)replies_.text("[MSG:Tool T").number(interpreter_.modal().tool).text(": length ");
    protocol::write_length(replies_, tool_changer_.length_nm(),
                           stored_.settings.on(Setting::kReportInches));
    (void)replies_.character(']').end_line();
}

}  // namespace cusp::machine
