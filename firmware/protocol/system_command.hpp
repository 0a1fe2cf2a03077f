// Parses '$' commands, without executing them.
#pragma once

#include <cstdint>
#include <string_view>

#include "firmware/base/axis.hpp"
#include "firmware/base/result.hpp"

namespace cusp::protocol {

enum class SystemCommandKind : std::uint8_t {
    kHelp,                 // $
    kSettings,             // $$
    kSetSetting,           // $<number>=<value>
    kParameters,           // $#
    kParserState,          // $G
    kBuildInfo,            // $I
    kSetBuildInfo,         // $I=<text>
    kStartupLines,         // $N
    kSetStartupLine,       // $N<number>=<line>
    kCheckMode,            // $C
    kUnlock,               // $X
    kHome,                 // $H, $HX, $HY, $HZ
    kJog,                  // $J=<words>
    kSleep,                // $SLP
    kRestoreSettings,      // $RST=$
    kRestoreParameters,    // $RST=#
    kRestoreAll,           // $RST=*
    kSettingDescriptions,  // $ES
    kSettingGroups,        // $EG
    kErrorCodes,           // $EE
    kAlarmCodes,           // $EA
    kCheckedLinesOn,       // $CRC=1
    kCheckedLinesOff,      // $CRC=0
};

struct SystemCommand {
    SystemCommandKind kind{SystemCommandKind::kHelp};
    std::uint32_t number{0};  // of a setting or startup line
    float value{0};           // kSetSetting
    AxisMask axes;            // kHome: empty for the whole cycle
    std::string_view text;    // kJog, kSetStartupLine, kSetBuildInfo: the text after the '='
};

// Reads a line that begins with '$', clean as LineAssembler leaves it. The text of the result is a
// part of the line.
//
// Errors, as Grbl gives them:
//   kInvalidStatement  a known letter followed by something else, or a number without '='
//   kBadNumberFormat   neither a known letter nor a number; a value that is no number
Result<SystemCommand> parse_system_command(std::string_view line) noexcept;

}  // namespace cusp::protocol
