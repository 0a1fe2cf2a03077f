// The '$' commands, performed.
#include "firmware/machine/machine.hpp"
#include "firmware/machine/travel.hpp"

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
    if (const std::optional<Error> error = refusal(command->kind)) {
        finish_line(error);
        return;
    }
    perform(*command);
}

// True if the state forbids the command.
std::optional<Error> Machine::refusal(SystemCommandKind kind) const noexcept
{
    const bool ready = state_ == State::kIdle || state_ == State::kAlarm;
    bool allowed = ready;
    switch (kind) {
        case SystemCommandKind::kHelp:
        case SystemCommandKind::kParserState:
        case SystemCommandKind::kUnlock:
        case SystemCommandKind::kCheckedLinesOn:
        case SystemCommandKind::kCheckedLinesOff:
            allowed = true;
            break;
        case SystemCommandKind::kSettings:
            allowed = state_ != State::kRun && state_ != State::kHold;
            break;
        case SystemCommandKind::kCheckMode:
            allowed = ready || state_ == State::kCheck;
            break;
        case SystemCommandKind::kJog:
            allowed = state_ == State::kIdle || state_ == State::kJog;
            break;
        case SystemCommandKind::kSetStartupLine:
            allowed = state_ == State::kIdle;
            break;
        case SystemCommandKind::kSetSetting:
        case SystemCommandKind::kParameters:
        case SystemCommandKind::kBuildInfo:
        case SystemCommandKind::kSetBuildInfo:
        case SystemCommandKind::kStartupLines:
        case SystemCommandKind::kHome:
        case SystemCommandKind::kSleep:
        case SystemCommandKind::kRestoreSettings:
        case SystemCommandKind::kRestoreParameters:
        case SystemCommandKind::kRestoreAll:
            break;
    }
    return allowed ? std::nullopt : std::optional<Error>{Error::kIdleError};
}

// Over 60 lines: one switch over all commands.
void Machine::perform(const SystemCommand& command) noexcept
{
    switch (command.kind) {
        case SystemCommandKind::kHelp:
            (void)replies_.text("[HLP:$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H ");
            (void)replies_.text("$CRC=1 ~ ! ? ctrl-x]").end_line();
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
            switch_off();
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
            checked_.switch_on();
            return;
        case SystemCommandKind::kCheckedLinesOff:
            finish_line(std::nullopt);
            checked_.switch_off();
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
        tell_range(number, value);
        finish_line(error);
        return;
    }
    if (const std::optional<SettingFault> fault = changed.find_fault(board_)) {
        tell_fault(*fault);
        finish_line(fault->error);
        return;
    }
    stored_.settings = changed;
    store_wanted_ = true;
    task_ = Task::kConfigure;
}

// The range of a setting that Grbl does not have, and so no sender knows.
void Machine::tell_range(std::uint32_t number, float value) noexcept
{
    constexpr std::uint32_t kFirst = 810;
    constexpr unsigned kDecimals = 3;
    for (std::size_t i = 0; i < kSettingCount; ++i) {
        const SettingEntry& entry = setting_entry(i);
        if (entry.number == number && number >= kFirst) {
            const auto write = [this](float x) {
                (void)replies_.decimal(protocol::scaled(x, kDecimals), kDecimals);
            };
            (void)replies_.text("[MSG:$").number(number).text(" is ");
            write(value);
            (void)replies_.text(", range ");
            write(entry.least);
            (void)replies_.text(" to ");
            write(entry.most);
            (void)replies_.text("]").end_line();
        }
    }
}

// Both settings by number and value, and what they come to.
void Machine::tell_fault(const SettingFault& fault) noexcept
{
    if (fault.first == 0) {
        return;
    }
    if (fault.second == 0) {
        (void)replies_.text("[MSG:$").number(fault.first);
        (void)replies_.text(": this board has no second motor]").end_line();
        return;
    }
    if (fault.of_board) {
        (void)replies_.text("[MSG:$").number(fault.first).text(" x $").number(fault.second);
        (void)replies_.text(" asks for ").number(static_cast<std::uint32_t>(fault.amount + 0.5F));
        (void)replies_.text(" steps/s, this board plays ");
        (void)replies_.number(static_cast<std::uint32_t>(fault.limit)).text("]").end_line();
        return;
    }
    const bool rate = fault.error == Error::kMaxStepRateExceeded;
    constexpr unsigned kDecimals = 3;
    constexpr float kMillisecondsPerSecond = 1000.0F;
    const float unit = rate ? 1.0F : kMillisecondsPerSecond;
    (void)replies_.text("[MSG:$").number(fault.first).text(rate ? " x $" : " / $");
    (void)replies_.number(fault.second).text(rate ? " needs steps " : " asks for a filter of ");
    (void)replies_.decimal(protocol::scaled(fault.amount * unit, kDecimals), kDecimals);
    (void)replies_.text(rate ? " us apart, least 2 x $0 = " : " ms, most ");
    (void)replies_.decimal(protocol::scaled(fault.limit * unit, kDecimals), kDecimals);
    (void)replies_.text(rate ? " us]" : " ms]").end_line();
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
    motion_.guard_limits(false);
    state_ = State::kHome;
    answer_after_startup_ = false;
    homing_axes_ = axes;
    homing_.begin(axes, stored_.settings);
    task_ = Task::kHome;
}

void Machine::start_jog(std::string_view words) noexcept
{
    if (line_cancelled()) {
        finish_line(std::nullopt);
        return;
    }
    const Status status = interpreter_.execute_jog(words, line_number_);
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
