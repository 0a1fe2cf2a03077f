// One row a command.
#include "firmware/machine/command_rules.hpp"

namespace cusp::machine {

using protocol::SystemCommandKind;

bool allows(State state, SystemCommandKind kind) noexcept
{
    const bool ready = state == State::kIdle || state == State::kAlarm;
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
        case SystemCommandKind::kSettingDescriptions:
        case SystemCommandKind::kSettingGroups:
        case SystemCommandKind::kErrorCodes:
        case SystemCommandKind::kAlarmCodes:
            allowed = state != State::kRun && state != State::kHold;
            break;
        case SystemCommandKind::kCheckMode:
            allowed = ready || state == State::kCheck;
            break;
        case SystemCommandKind::kJog:
            allowed = state == State::kIdle || state == State::kJog;
            break;
        case SystemCommandKind::kSetStartupLine:
            allowed = state == State::kIdle;
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
    return allowed;
}

}  // namespace cusp::machine
