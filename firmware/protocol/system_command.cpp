// Matches the text of '$' commands.
#include "firmware/protocol/system_command.hpp"

#include <array>
#include <optional>

namespace cusp::protocol {
namespace {

struct Word {
    std::string_view text;
    SystemCommandKind kind;
    AxisMask axes;
};

constexpr std::array<Word, 23> kWords{{
    {"", SystemCommandKind::kHelp, {}},
    {"$", SystemCommandKind::kSettings, {}},
    {"#", SystemCommandKind::kParameters, {}},
    {"G", SystemCommandKind::kParserState, {}},
    {"I", SystemCommandKind::kBuildInfo, {}},
    {"N", SystemCommandKind::kStartupLines, {}},
    {"C", SystemCommandKind::kCheckMode, {}},
    {"X", SystemCommandKind::kUnlock, {}},
    {"H", SystemCommandKind::kHome, {}},
    {"HX", SystemCommandKind::kHome, {1}},
    {"HY", SystemCommandKind::kHome, {2}},
    {"HZ", SystemCommandKind::kHome, {4}},
    {"HA", SystemCommandKind::kHome, {8}},
    {"SLP", SystemCommandKind::kSleep, {}},
    {"RST=$", SystemCommandKind::kRestoreSettings, {}},
    {"RST=#", SystemCommandKind::kRestoreParameters, {}},
    {"RST=*", SystemCommandKind::kRestoreAll, {}},
    {"ES", SystemCommandKind::kSettingDescriptions, {}},
    {"EG", SystemCommandKind::kSettingGroups, {}},
    {"EE", SystemCommandKind::kErrorCodes, {}},
    {"EA", SystemCommandKind::kAlarmCodes, {}},
    {"CRC=1", SystemCommandKind::kCheckedLinesOn, {}},
    {"CRC=0", SystemCommandKind::kCheckedLinesOff, {}},
}};

// An unsigned or signed decimal number at the start of `text`, which moves behind it. Digits beyond
// the ninth significant one only scale, as nothing here needs more.
std::optional<float> take_number(std::string_view& text) noexcept
{
    std::size_t i = 0;
    const bool negative = !text.empty() && text[0] == '-';
    if (negative || (!text.empty() && text[0] == '+')) {
        ++i;
    }
    std::uint32_t mantissa = 0;
    double scale = 1.0;
    bool point = false;
    bool any_digit = false;
    for (; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '.' && !point) {
            point = true;
            continue;
        }
        if (c < '0' || c > '9') {
            break;
        }
        any_digit = true;
        constexpr std::uint32_t kMostMantissa = 99'999'999;
        const bool counts = mantissa <= kMostMantissa;
        if (counts) {
            mantissa = mantissa * 10U + static_cast<std::uint32_t>(c - '0');
        }
        if (counts && point) {
            scale *= 10.0;
        } else if (!counts && !point) {
            scale /= 10.0;
        }
    }
    if (!any_digit) {
        return std::nullopt;
    }
    text.remove_prefix(i);
    const auto value = static_cast<float>(static_cast<double>(mantissa) / scale);
    return negative ? -value : value;
}

bool starts_with(std::string_view text, std::string_view start) noexcept
{
    return text.substr(0, start.size()) == start;
}

// $<number>=, with the number a whole one. The text moves behind the '='.
Result<std::uint32_t> take_setting_number(std::string_view& text) noexcept
{
    const std::optional<float> number = take_number(text);
    if (!number) {
        return Error::kBadNumberFormat;
    }
    constexpr float kMostNumber = 9999.0F;
    const bool whole = *number >= 0 && *number <= kMostNumber &&
                       *number == static_cast<float>(static_cast<std::uint32_t>(*number));
    if (!whole || text.empty() || text[0] != '=') {
        return Error::kInvalidStatement;
    }
    text.remove_prefix(1);
    return static_cast<std::uint32_t>(*number);
}

Result<SystemCommand> parse_setting(std::string_view text, bool startup_line) noexcept
{
    const Result<std::uint32_t> number = take_setting_number(text);
    if (!number) {
        return number.error();
    }
    SystemCommand command;
    command.number = *number;
    if (startup_line) {
        command.kind = SystemCommandKind::kSetStartupLine;
        command.text = text;
        return command;
    }
    const std::optional<float> value = take_number(text);
    if (!value) {
        return Error::kBadNumberFormat;
    }
    if (!text.empty()) {
        return Error::kInvalidStatement;
    }
    command.kind = SystemCommandKind::kSetSetting;
    command.value = *value;
    return command;
}

SystemCommand with_text(SystemCommandKind kind, std::string_view text) noexcept
{
    SystemCommand command;
    command.kind = kind;
    command.text = text;
    return command;
}

}  // namespace

Result<SystemCommand> parse_system_command(std::string_view line) noexcept
{
    std::string_view text = line.substr(1);
    for (const Word& word : kWords) {
        if (text == word.text) {
            SystemCommand command;
            command.kind = word.kind;
            command.axes = word.axes;
            return command;
        }
    }
    if (starts_with(text, "J=")) {
        return with_text(SystemCommandKind::kJog, text.substr(2));
    }
    if (starts_with(text, "I=")) {
        return with_text(SystemCommandKind::kSetBuildInfo, text.substr(2));
    }
    if (text[0] == 'N') {
        text.remove_prefix(1);
        return parse_setting(text, true);
    }
    constexpr std::string_view kKnownLetters = "$#GICXHSRJ";
    if (kKnownLetters.find(text[0]) != std::string_view::npos) {
        return Error::kInvalidStatement;
    }
    return parse_setting(text, false);
}

}  // namespace cusp::protocol
