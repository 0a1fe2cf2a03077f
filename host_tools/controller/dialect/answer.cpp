// Parses answers; texts of codes.
#include "host_tools/controller/dialect/answer.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include "host_tools/controller/dialect/leading_number.hpp"

namespace cusp::dialect {
namespace {

std::optional<int> whole_number(std::string_view text)
{
    int number = 0;
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failed != std::errc{} || end != text.data() + text.size()) {
        return std::nullopt;
    }
    return number;
}

// Returns the part before `separator`; the remainder stays in `text`.
std::string_view split_off(std::string_view& text, char separator)
{
    const std::size_t at = text.find(separator);
    const std::string_view head = text.substr(0, at);
    text = at == std::string_view::npos ? std::string_view{} : text.substr(at + 1);
    return head;
}

std::optional<double> decimal(std::string_view text)
{
    const auto number = leading_number(text);
    return number ? std::optional{number->value} : std::nullopt;
}

std::optional<AxisVecd> vector_of(std::string_view text)
{
    AxisVecd vector;
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        constexpr double kFarthest = 1e7;  // mm; a damaged number may be any
        if (axis >= kLinearAxes && text.empty()) {
            break;
        }
        const auto number = decimal(split_off(text, ','));
        if (!number || std::abs(*number) > kFarthest) {
            return std::nullopt;
        }
        vector[axis] = *number;
    }
    return vector;
}

void take_field(ControllerStatus& status, std::string_view name, std::string_view value)
{
    if (name == "MPos") {
        status.machine_position = vector_of(value);
    } else if (name == "WPos") {
        status.work_position = vector_of(value);
    } else if (name == "WCO") {
        status.work_offset = vector_of(value);
    } else if (name == "Ln") {
        if (const auto line = whole_number(value); line && *line >= 0) {
            status.line = static_cast<std::uint32_t>(*line);
        }
    } else if (name == "F" || name == "FS") {
        status.feed = decimal(value);
    } else if (name == "Bf") {
        status.free_blocks = whole_number(split_off(value, ','));
    } else if (name == "Ov") {
        status.feed_override = whole_number(split_off(value, ','));
    }
}

ControllerStatus status_of(std::string_view fields)
{
    ControllerStatus status;
    std::string_view state = split_off(fields, '|');
    status.state = split_off(state, ':');
    status.substate = whole_number(state).value_or(-1);
    while (!fields.empty()) {
        std::string_view value = split_off(fields, '|');
        const std::string_view name = split_off(value, ':');
        take_field(status, name, value);
    }
    return status;
}

bool starts_with(std::string_view text, std::string_view start)
{
    return text.substr(0, start.size()) == start;
}

std::optional<int> code_after(std::string_view line, std::string_view word)
{
    return starts_with(line, word) ? whole_number(line.substr(word.size())) : std::nullopt;
}

struct CodeText {
    int code;
    std::string_view text;
};

constexpr CodeText kErrors[]{
    {1, "a word has no letter"},
    {2, "a number is missing or malformed"},
    {3, "this $ command is not known"},
    {4, "a value is negative"},
    {5, "homing is switched off, or the board lacks the pins"},
    {6, "the step pulse is too short"},
    {7, "the stored settings could not be read"},
    {8, "the controller is not idle"},
    {9, "G-code is locked out in alarm, jog or sleep"},
    {10, "soft limits need homing"},
    {11, "the line is too long"},
    {12, "the setting requires too high a step rate"},
    {13, "the safety door is open"},
    {14, "the startup line or build info is too long"},
    {15, "the jog goes beyond the travel"},
    {16, "the jog command is malformed"},
    {17, "laser mode needs a PWM spindle"},
    {20, "a G or M word is not supported"},
    {21, "two words of one modal group"},
    {22, "no feed rate is set"},
    {23, "a G or M number must be whole"},
    {24, "two commands use the axis words"},
    {25, "a word is repeated"},
    {26, "axis words are missing"},
    {27, "the line number is out of range"},
    {28, "a value word is missing"},
    {29, "the work coordinate system is not supported"},
    {30, "G53 needs G0 or G1"},
    {31, "unused axis words"},
    {32, "an arc has no axis word in its plane"},
    {33, "the target or geometry is impossible"},
    {34, "no arc of this radius reaches the target"},
    {35, "an arc has no centre offset in its plane"},
    {36, "unused value words"},
    {37, "a tool length offset on an axis other than Z"},
    {38, "a number is too large"},
    {46, "the tool change needs a homed machine"},
    {47, "the place of the tool change, G59.3, is not set"},
};

constexpr CodeText kAlarms[]{
    {1, "a hard limit was hit; the position may be lost"},
    {2, "the target is beyond the soft limits"},
    {3, "reset in motion; the position may be lost"},
    {4, "the probe was not in its initial state"},
    {5, "the probe did not touch"},
    {6, "homing was reset"},
    {7, "the door was opened while homing"},
    {8, "homing could not clear the switch"},
    {9, "homing did not find the switch"},
    {10, "the emergency stop is pressed"},
    {14, "the spindle did not come up to speed in time"},
    {15, "a switch of an axis with two motors did not close in time"},
    {17, "a motor driver reports a fault"},
};

template <std::size_t N>
std::string_view text_of(const CodeText (&texts)[N], int code)
{
    const auto* const found =
        std::find_if(std::begin(texts), std::end(texts),
                     [code](const CodeText& entry) { return entry.code == code; });
    return found == std::end(texts) ? kUnknownCode : found->text;
}

}  // namespace

Answer parse_answer(std::string_view line)
{
    Answer answer;
    answer.text = line;
    if (line == "ok") {
        answer.kind = AnswerKind::kOk;
    } else if (const auto error = code_after(line, "error:")) {
        answer.kind = AnswerKind::kError;
        answer.code = *error;
    } else if (const auto alarm = code_after(line, "ALARM:")) {
        answer.kind = AnswerKind::kAlarm;
        answer.code = *alarm;
    } else if (line.size() > 2 && line.front() == '<' && line.back() == '>') {
        answer.kind = AnswerKind::kStatus;
        answer.status = status_of(line.substr(1, line.size() - 2));
    } else if (line.size() > 2 && line.front() == '[' && line.back() == ']') {
        answer.kind = AnswerKind::kMessage;
        answer.text = line.substr(1, line.size() - 2);
    } else if (starts_with(line, "Grbl")) {
        answer.kind = AnswerKind::kBanner;
    }
    return answer;
}

std::string_view error_text(int code) { return text_of(kErrors, code); }
std::string_view alarm_text(int code) { return text_of(kAlarms, code); }

}  // namespace cusp::dialect
