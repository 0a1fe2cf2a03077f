// The '$' commands, performed.
#include "firmware/machine/system_commands.hpp"

#include "firmware/machine/command_rules.hpp"

namespace cusp::machine {
namespace {

using protocol::SystemCommand;
using protocol::SystemCommandKind;
using Next = CommandOutcome::Next;

CommandOutcome refusal(Error error) noexcept
{
    CommandOutcome outcome;
    outcome.error = error;
    return outcome;
}

CommandOutcome then(Next next) noexcept
{
    CommandOutcome outcome;
    outcome.next = next;
    return outcome;
}

CommandOutcome then_reset(Next next) noexcept
{
    CommandOutcome outcome = then(next);
    outcome.resets = true;
    return outcome;
}

}  // namespace

CommandOutcome SystemCommands::perform(std::string_view line) noexcept
{
    // Grbl looks at the state before it reads a setting or a startup line.
    const Result<SystemCommand> command = protocol::parse_system_command(line);
    const SystemState& system = core_.system;
    if (!command) {
        const bool blocked = command.error() == Error::kBadNumberFormat &&
                             !system.is(State::kIdle) && !system.is(State::kAlarm);
        return refusal(blocked ? Error::kIdleError : command.error());
    }
    if (!allows(system.state(), command->kind)) {
        return refusal(Error::kIdleError);
    }
    return perform(*command);
}

// Over 60 lines: one switch over all commands.
CommandOutcome SystemCommands::perform(const SystemCommand& command) noexcept
{
    switch (command.kind) {
        case SystemCommandKind::kHelp:
            (void)core_.replies.text("[HLP:$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H ");
            (void)core_.replies.text("$CRC=1 $ES $EG $EE $EA ~ ! ? ctrl-x]").end_line();
            return {};
        case SystemCommandKind::kSettings:
            return list(Listing::kSettings);
        case SystemCommandKind::kParameters:
            return list(Listing::kParameters);
        case SystemCommandKind::kStartupLines:
            return list(Listing::kStartupLines);
        case SystemCommandKind::kBuildInfo:
            return list(Listing::kBuild);
        case SystemCommandKind::kSettingDescriptions:
            return list(Listing::kSettingDescriptions);
        case SystemCommandKind::kSettingGroups:
            return list(Listing::kSettingGroups);
        case SystemCommandKind::kErrorCodes:
            return list(Listing::kErrorCodes);
        case SystemCommandKind::kAlarmCodes:
            return list(Listing::kAlarmCodes);
        case SystemCommandKind::kParserState:
            write_modal_state(core_.interpreter.modal(), core_.settings(), core_.replies);
            return {};
        case SystemCommandKind::kSetSetting:
            return set_setting(command.number, command.value);
        case SystemCommandKind::kSetBuildInfo:
            return set_build(command.text);
        case SystemCommandKind::kSetStartupLine:
            return set_startup_line(command);
        case SystemCommandKind::kCheckMode:
            return toggle_check_mode();
        case SystemCommandKind::kUnlock:
            return unlock();
        case SystemCommandKind::kHome:
            return home(command.axes);
        case SystemCommandKind::kJog:
            return jog(command.text);
        case SystemCommandKind::kSleep:
            core_.system.enter(State::kSleep);
            core_.outputs.switch_off();
            return {};
        case SystemCommandKind::kRestoreSettings:
            return restore(true, false, false);
        case SystemCommandKind::kRestoreParameters:
            return restore(false, true, false);
        case SystemCommandKind::kRestoreAll:
            return restore(true, true, true);
        case SystemCommandKind::kCheckedLinesOn:
            return then(Next::kCheckedLines);
        case SystemCommandKind::kCheckedLinesOff:
            return then(Next::kPlainLines);
    }
    return {};
}

CommandOutcome SystemCommands::list(Listing listing) noexcept
{
    reports_.begin(listing);
    return then(Next::kListing);
}

CommandOutcome SystemCommands::set_setting(std::uint32_t number, float value) noexcept
{
    if (const auto error = core_.keeper.change(number, value, core_.replies)) {
        return refusal(*error);
    }
    return then(Next::kConfigure);
}

CommandOutcome SystemCommands::restore(bool settings, bool parameters, bool texts) noexcept
{
    SettingsKeeper& keeper = core_.keeper;
    if (settings) {
        keeper.restore_settings();
    }
    if (parameters) {
        keeper.stored().parameters = gcode::Parameters{};
        core_.interpreter.set_parameters(keeper.stored().parameters);
    }
    if (texts) {
        keeper.forget_texts();
    }
    core_.message("Restoring defaults");
    keeper.want_store();
    return then_reset(Next::kConfigure);
}

CommandOutcome SystemCommands::toggle_check_mode() noexcept
{
    if (core_.system.reset_needed()) {
        return refusal(Error::kSystemGcLock);
    }
    if (core_.system.is(State::kCheck)) {
        core_.message("Disabled");
        return then_reset(Next::kAnswer);
    }
    core_.system.enter_check();
    core_.message("Enabled");
    return {};
}

CommandOutcome SystemCommands::unlock() noexcept
{
    if (!core_.system.is(State::kAlarm)) {
        return {};
    }
    if (core_.system.reset_needed()) {
        return refusal(Error::kSystemGcLock);
    }
    if (core_.input_on(kDoor)) {
        return refusal(Error::kCheckDoor);
    }
    core_.message("Caution: Unlocked");
    core_.system.clear_alarm();
    return {};
}

CommandOutcome SystemCommands::home(AxisMask axes) noexcept
{
    if (const std::optional<Error> error = homing_.begin(axes)) {
        return refusal(*error);
    }
    return then(Next::kHome);
}

CommandOutcome SystemCommands::jog(std::string_view words) noexcept
{
    if (core_.lines.cancelled()) {
        return {};
    }
    const Status status = actions_.read_jog(words);
    if (!status) {
        return refusal(status.error());
    }
    return then(Next::kActions);
}

CommandOutcome SystemCommands::set_startup_line(const SystemCommand& command) noexcept
{
    if (command.number >= kStartupLineCount) {
        return refusal(Error::kInvalidStatement);
    }
    if (command.text.size() > kStoredTextLength) {
        return refusal(Error::kLineLengthExceeded);
    }
    startup_.propose(command.number, command.text);
    return then(Next::kTryStartupLine);
}

CommandOutcome SystemCommands::set_build(std::string_view text) noexcept
{
    if (text.size() > kStoredTextLength) {
        return refusal(Error::kLineLengthExceeded);
    }
    core_.keeper.stored().build.set(text);
    core_.keeper.want_store();
    return then(Next::kFinish);
}

}  // namespace cusp::machine
