// The steps of M6.
#include "firmware/machine/tool_change_command.hpp"

namespace cusp::machine {
namespace {

constexpr std::size_t kPlace = gcode::kCoordinateSystems - 1;  // G59.3

// Machine zero is at the limit switches, which is no place for a tool change: a coordinate system that
// lies there was not set.
bool is_set(Position place) noexcept { return !(place == Position{}); }

}  // namespace

gcode::ToolChangeRule ToolChangeCommand::rule() const noexcept
{
    const bool checks = core_.system.is(State::kCheck);
    const ToolChangeMode mode = tool_change_mode(core_.settings());
    const unsigned needed = axes_to_home(mode).bits;
    if (!checks && (core_.system.homed().bits & needed) != needed) {
        return gcode::ToolChangeRule::kNotHomed;
    }
    const bool travels = mode == ToolChangeMode::kAtPlace || mode == ToolChangeMode::kTouchOff;
    if (travels && !checks && !is_set(core_.interpreter.parameters().work_offsets[kPlace])) {
        return gcode::ToolChangeRule::kNoPlace;
    }
    return mode == ToolChangeMode::kTouchOff ? gcode::ToolChangeRule::kTouchOff
                                             : gcode::ToolChangeRule::kFree;
}

ActionProgress ToolChangeCommand::begin(const gcode::ToolChange& change) noexcept
{
    const ToolChangeMode mode = tool_change_mode(core_.settings());
    if (mode == ToolChangeMode::kIgnore) {
        return ActionProgress::kDone;
    }
    if (!core_.wait_settled()) {
        return ActionProgress::kWaits;
    }
    if (mode == ToolChangeMode::kPause) {
        ask_for_tool(change.tool);
        cycle_.hold_after_line();
    } else {
        start(change, mode);
    }
    return ActionProgress::kDone;
}

void ToolChangeCommand::ask_for_tool(unsigned tool) noexcept
{
    (void)core_.replies.text("[MSG:Tool change T").number(tool);
    (void)core_.replies.text(": cycle start to go on]").end_line();
}

void ToolChangeCommand::start(const gcode::ToolChange& change, ToolChangeMode mode) noexcept
{
    const gcode::Parameters& parameters = core_.interpreter.parameters();
    const std::int64_t offset = parameters.tool_length_offset_nm;
    const bool known = gcode::ToolTable::holds(change.tool) && parameters.tools.has(change.tool);
    const std::uint32_t number = core_.lines.line_number();
    changer_.begin({mode, parameters.work_offsets[kPlace], offset,
                    known ? parameters.tools.length_nm(change.tool) : offset,
                    number > 0 ? number : change.line},
                   core_.motion);
    core_.outputs.begin_tool_change();
    active_ = true;
}

ActionProgress ToolChangeCommand::step() noexcept
{
    const ToolChanger::Progress progress = changer_.step(core_.motion, core_.settings());
    // Also between its moves: senders take Idle as the end of the line.
    if (core_.system.is(State::kIdle)) {
        core_.system.enter(State::kRun);
    }
    switch (progress) {
        case ToolChanger::Progress::kWaiting:
            return ActionProgress::kWaits;
        case ToolChanger::Progress::kStepped:
            break;
        case ToolChanger::Progress::kAtChange:
            ask_for_tool(core_.interpreter.modal().tool);
            cycle_.hold();
            break;
        case ToolChanger::Progress::kMeasured:
            take_length();
            break;
        case ToolChanger::Progress::kOverPart:
            core_.outputs.end_tool_change();
            changer_.rest(core_.outputs.up_at());
            break;
        case ToolChanger::Progress::kFailed:
            return ActionProgress::kAlarm;
        case ToolChanger::Progress::kFinished:
            active_ = false;
            break;
    }
    return ActionProgress::kDone;
}

void ToolChangeCommand::take_length() noexcept
{
    core_.interpreter.take_tool_length(changer_.length_nm());
    core_.reporter.work_offset_changed();
    (void)core_.replies.text("[MSG:Tool T").number(core_.interpreter.modal().tool);
    (void)core_.replies.text(": length ");
    protocol::write_length(core_.replies, changer_.length_nm(),
                           core_.settings().on(Setting::kReportInches));
    (void)core_.replies.character(']').end_line();
}

}  // namespace cusp::machine
