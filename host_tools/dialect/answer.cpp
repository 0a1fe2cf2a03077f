// Parsing of answers, and the words for codes.
#include "host_tools/dialect/answer.hpp"

#include <array>
#include <charconv>

#include "host_tools/dialect/leading_number.hpp"

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

// Up to `separator`; the rest stays in `text`.
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

std::optional<Vec3d> vector_of(std::string_view text)
{
    Vec3d vector;
    for (unsigned axis = 0; axis < 3; ++axis) {
        const auto number = decimal(split_off(text, ','));
        if (!number) {
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

constexpr std::array<std::string_view, 47> kErrors{
    "",
    "a word has no letter",
    "a number is missing or malformed",
    "this $ command is not known",
    "a value is negative",
    "homing is switched off",
    "the step pulse is too short",
    "the stored settings could not be read",
    "the controller is not idle",
    "G-code is locked out in alarm, jog or sleep",
    "soft limits need homing",
    "the line is too long",
    "the setting asks for too high a step rate",
    "the safety door is open",
    "the startup line or build info is too long",
    "the jog goes beyond the travel",
    "the jog command is malformed",
    "laser mode needs a PWM spindle",
    "unknown",
    "unknown",
    "a G or M word is not supported",
    "two words of one modal group",
    "no feed rate is set",
    "a G or M number must be whole",
    "two commands both want the axis words",
    "a word is repeated",
    "axis words are missing",
    "the line number is out of range",
    "a value word is missing",
    "the work coordinate system is not supported",
    "G53 needs G0 or G1",
    "axis words that nothing uses",
    "an arc has no axis word in its plane",
    "the target or geometry is impossible",
    "no arc of this radius reaches the target",
    "an arc has no centre offset in its plane",
    "value words that nothing uses",
    "a tool length offset on an axis other than Z",
    "a number is too large",
    "unknown",
    "unknown",
    "unknown",
    "unknown",
    "unknown",
    "unknown",
    "unknown",
    "the tool change needs a homed machine",
};

constexpr std::array<std::string_view, 18> kAlarms{
    "",
    "a hard limit was hit; the position may be lost",
    "the target is beyond the soft limits",
    "reset in motion; the position may be lost",
    "the probe was not in its initial state",
    "the probe did not touch",
    "homing was reset",
    "the door was opened while homing",
    "homing could not clear the switch",
    "homing did not find the switch",
    "the emergency stop is pressed",
    "unknown",
    "unknown",
    "unknown",
    "unknown",
    "unknown",
    "unknown",
    "a motor driver reports a fault",
};

template <std::size_t N>
std::string_view text_at(const std::array<std::string_view, N>& texts, int code)
{
    return code > 0 && static_cast<std::size_t>(code) < N ? texts[static_cast<std::size_t>(code)]
                                                          : "unknown";
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

std::string_view error_text(int code) { return text_at(kErrors, code); }
std::string_view alarm_text(int code) { return text_at(kAlarms, code); }

}  // namespace cusp::dialect
