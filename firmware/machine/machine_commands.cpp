// The '$' commands, performed.
#include "firmware/machine/command_rules.hpp"
#include "firmware/machine/machine.hpp"
#include "firmware/machine/setting_messages.hpp"

namespace cusp::machine {

using protocol::SystemCommand;
using protocol::SystemCommandKind;

void Machine::execute_command(std::string_view text) noexcept
{
    // Grbl looks at the state before it reads a setting or a startup line.
    const Result<SystemCommand> command = protocol::parse_system_command(text);
    if (!command) {
        const bool blocked = command.error() == Error::kBadNumberFormat && state_ != State::kIdle &&
                             state_ != State::kAlarm;
        finish_line(blocked ? Error::kIdleError : command.error());
        return;
    }
    if (!allows(state_, command->kind)) {
        finish_line(Error::kIdleError);
        return;
    }
    perform(*command);
}

// Over 60 lines: one switch over all commands.
void Machine::perform(const SystemCommand& command) noexcept
{
    switch (command.kind) {
        case SystemCommandKind::kHelp:
            (void)replies_.text("[HLP:$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H ");
            (void)replies_.text("$CRC=1 $ES $EG $EE $EA ~ ! ? ctrl-x]").end_line();
            break;
        case SystemCommandKind::kSettings:
            start_listing(Listing::kSettings);
            return;
        case SystemCommandKind::kParameters:
            start_listing(Listing::kParameters);
            return;
        case SystemCommandKind::kStartupLines:
            start_listing(Listing::kStartupLines);
            return;
        case SystemCommandKind::kBuildInfo:
            start_listing(Listing::kBuild);
            return;
        case SystemCommandKind::kSettingDescriptions:
            start_listing(Listing::kSettingDescriptions);
            return;
        case SystemCommandKind::kSettingGroups:
            start_listing(Listing::kSettingGroups);
            return;
        case SystemCommandKind::kErrorCodes:
            start_listing(Listing::kErrorCodes);
            return;
        case SystemCommandKind::kAlarmCodes:
            start_listing(Listing::kAlarmCodes);
            return;
        case SystemCommandKind::kParserState:
            write_modal_state(interpreter_.modal(), stored_.settings, replies_);
            break;
        case SystemCommandKind::kSetSetting:
            set_setting(command.number, command.value);
            return;
        case SystemCommandKind::kSetBuildInfo:
            set_build(command.text);
            return;
        case SystemCommandKind::kSetStartupLine:
            set_startup_line(command);
            return;
        case SystemCommandKind::kCheckMode:
            toggle_check_mode();
            return;
        case SystemCommandKind::kUnlock:
            unlock();
            return;
        case SystemCommandKind::kHome:
            start_homing(command.axes);
            return;
        case SystemCommandKind::kJog:
            start_jog(command.text);
            return;
        case SystemCommandKind::kSleep:
            state_ = State::kSleep;
            outputs_.switch_off();
            break;
        case SystemCommandKind::kRestoreSettings:
            restore(true, false, false);
            return;
        case SystemCommandKind::kRestoreParameters:
            restore(false, true, false);
            return;
        case SystemCommandKind::kRestoreAll:
            restore(true, true, true);
            return;
        case SystemCommandKind::kCheckedLinesOn:
            finish_line(std::nullopt);
            lines_.switch_checked(true);
            return;
        case SystemCommandKind::kCheckedLinesOff:
            finish_line(std::nullopt);
            lines_.switch_checked(false);
            return;
    }
    finish_line(std::nullopt);
}

void Machine::start_listing(Listing listing) noexcept
{
    listing_ = listing;
    listing_index_ = 0;
    task_ = Task::kListing;
}

void Machine::set_setting(std::uint32_t number, float value) noexcept
{
    Settings changed = stored_.settings;
    if (const std::optional<Error> error = changed.put(number, value)) {
        tell_range(number, value, replies_);
        finish_line(error);
        return;
    }
    if (const std::optional<SettingFault> fault = changed.find_fault(board_)) {
        tell_fault(*fault, replies_);
        finish_line(fault->error);
        return;
    }
    stored_.settings = changed;
    store_wanted_ = true;
    task_ = Task::kConfigure;
}

void Machine::restore_settings() noexcept
{
    stored_.settings = factory_ != nullptr ? *factory_ : Settings{};
}

void Machine::restore(bool settings, bool parameters, bool texts) noexcept
{
    if (settings) {
        restore_settings();
    }
    if (parameters) {
        stored_.parameters = gcode::Parameters{};
        interpreter_.set_parameters(stored_.parameters);
    }
    if (texts) {
        stored_.startup = {};
        stored_.build = {};
    }
    message("Restoring defaults");
    store_wanted_ = true;
    reset_after_answer_ = true;
    task_ = Task::kConfigure;
}

void Machine::toggle_check_mode() noexcept
{
    if (reset_needed_) {
        finish_line(Error::kSystemGcLock);
        return;
    }
    if (state_ == State::kCheck) {
        message("Disabled");
        reset_after_answer_ = true;
    } else {
        locked_ = state_ == State::kAlarm;
        state_ = State::kCheck;
        message("Enabled");
    }
    finish_line(std::nullopt);
}

void Machine::unlock() noexcept
{
    if (state_ == State::kAlarm) {
        if (reset_needed_) {
            finish_line(Error::kSystemGcLock);
            return;
        }
        if (input_on(kDoor)) {
            finish_line(Error::kCheckDoor);
            return;
        }
        message("Caution: Unlocked");
        state_ = State::kIdle;
        alarm_ = Alarm::kNone;
    }
    finish_line(std::nullopt);
}

void Machine::start_homing(AxisMask axes) noexcept
{
    if (!stored_.settings.on(Setting::kHoming)) {
        finish_line(Error::kSettingDisabled);
        return;
    }
    if (reset_needed_) {
        finish_line(Error::kSystemGcLock);
        return;
    }
    if (input_on(kDoor)) {
        finish_line(Error::kCheckDoor);
        return;
    }
    homes_all_ = axes.empty();
    const unsigned wanted = homes_all_ ? stored_.settings.homed_axes().bits : axes.bits;
    homing_axes_.bits =
        static_cast<std::uint8_t>(wanted & stored_.settings.axes_with_switches().bits);
    if (homing_axes_.empty()) {
        finish_line(Error::kSettingDisabled);
        return;
    }
    motion_.guard_limits(false);
    state_ = State::kHome;
    answer_after_startup_ = false;
    homing_.begin(homing_axes_, stored_.settings);
    task_ = Task::kHome;
}

void Machine::start_jog(std::string_view words) noexcept
{
    if (lines_.cancelled()) {
        finish_line(std::nullopt);
        return;
    }
    const Status status = interpreter_.execute_jog(words, lines_.line_number());
    if (!status) {
        finish_line(status.error());
        return;
    }
    jogging_line_ = true;
    task_ = Task::kActions;
}

void Machine::set_startup_line(const SystemCommand& command) noexcept
{
    if (command.number >= kStartupLineCount) {
        finish_line(Error::kInvalidStatement);
        return;
    }
    if (command.text.size() > kStoredTextLength) {
        finish_line(Error::kLineLengthExceeded);
        return;
    }
    startup_number_ = static_cast<std::uint8_t>(command.number);
    startup_text_ = command.text;
    // As in Grbl the line is executed, which shows whether it can be.
    execute_gcode(command.text, Ending::kKeepStartupLine);
}

void Machine::set_build(std::string_view text) noexcept
{
    if (text.size() > kStoredTextLength) {
        finish_line(Error::kLineLengthExceeded);
        return;
    }
    stored_.build.set(text);
    store_wanted_ = true;
    task_ = Task::kFinish;
}

}  // namespace cusp::machine
