// Parses the commands of the control port.
#include "host_tools/controller/simulate/fault_command.hpp"

#include <array>
#include <utility>

#include "firmware/base/panel.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/number_text/number_text.hpp"

#include "fmt/format.h"

namespace cusp::simulate {

using number_text::number_of;

namespace {

// Returns the next word; the remainder stays in `text`.
std::string_view next_word(std::string_view& text, const char* separators)
{
    const std::size_t first = text.find_first_not_of(separators);
    if (first == std::string_view::npos) {
        text = {};
        return {};
    }
    text.remove_prefix(first);
    const std::size_t end = text.find_first_of(separators);
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(word.size());
    return word;
}

constexpr std::array<std::pair<std::string_view, FaultKind>, 12> kWords{{
    {"unplug", FaultKind::kUnplug},
    {"plug", FaultKind::kPlug},
    {"cut", FaultKind::kCutPowerAfter},
    {"high", FaultKind::kInputHigh},
    {"low", FaultKind::kInputLow},
    {"free", FaultKind::kInputFree},
    {"plate", FaultKind::kProbePlate},
    {"line", FaultKind::kLineFaults},
    {"lose-frame", FaultKind::kLoseFrame},
    {"overrun", FaultKind::kOverrun},
    {"where", FaultKind::kWhere},
    {"power", FaultKind::kPowerOff},
}};

std::optional<FaultKind> kind_named(std::string_view word)
{
    for (const auto& [name, kind] : kWords) {
        if (name == word) {
            return kind;
        }
    }
    return std::nullopt;
}

// Parses the arguments of the command. Returns whether they are valid.
bool read_rest(FaultCommand& command, std::string_view rest)
{
    std::string_view words = rest;
    const std::string_view word = next_word(words, " \t\r");
    switch (command.kind) {
        case FaultKind::kPowerOff:
            if (word == "on") {
                command.kind = FaultKind::kPowerOn;
            }
            return word == "on" || word == "off";
        case FaultKind::kCutPowerAfter:
        case FaultKind::kProbePlate:
            command.value = number_of(word).value_or(-1.0);
            return number_of(word).has_value() &&
                   (command.value >= 0 || command.kind == FaultKind::kProbePlate);
        case FaultKind::kInputHigh:
        case FaultKind::kInputLow:
        case FaultKind::kInputFree:
            command.inputs = input_named(word);
            return command.inputs != 0;
        case FaultKind::kLineFaults: {
            const auto faults = parse_line_faults(rest);
            command.faults = faults.value_or(hal::LineFaults{});
            return faults.has_value();
        }
        case FaultKind::kUnplug:
        case FaultKind::kPlug:
        case FaultKind::kPowerOn:
        case FaultKind::kLoseFrame:
        case FaultKind::kOverrun:
        case FaultKind::kWhere:
            break;
    }
    return word.empty();
}

}  // namespace

std::optional<FaultCommand> parse_fault_command(std::string_view line)
{
    std::string_view rest = line;
    const auto kind = kind_named(next_word(rest, " \t\r"));
    FaultCommand command;
    if (!kind) {
        return std::nullopt;
    }
    command.kind = *kind;
    return read_rest(command, rest) ? std::optional{command} : std::nullopt;
}

std::optional<hal::LineFaults> parse_line_faults(std::string_view text)
{
    hal::LineFaults faults;
    for (std::string_view word = next_word(text, " ,\t\r"); !word.empty();
         word = next_word(text, " ,\t\r")) {
        const std::size_t equals = word.find('=');
        const std::string_view name = word.substr(0, equals);
        const auto value =
            equals == std::string_view::npos ? std::nullopt : number_of(word.substr(equals + 1));
        if (!value || *value < 0.0 || *value > 1.0) {
            return std::nullopt;
        }
        if (name == "noise") {
            faults.noise = *value;
        } else if (name == "loss") {
            faults.loss = *value;
        } else if (name == "doubling") {
            faults.doubling = *value;
        } else if (name == "delay") {
            faults.delay = *value;
        } else {
            return std::nullopt;
        }
    }
    return faults;
}

std::uint16_t input_named(std::string_view name)
{
    constexpr std::array<std::pair<std::string_view, std::uint16_t>, 9> kNames{{
        {"x", kLimitX},
        {"y", kLimitY},
        {"z", kLimitZ},
        {"probe", kProbe},
        {"door", kDoor},
        {"hold", kHoldButton},
        {"start", kStartButton},
        {"reset", kResetButton},
        {"at-speed", kAtSpeed},
    }};
    for (const auto& [known, bit] : kNames) {
        if (known == name) {
            return bit;
        }
    }
    return 0;
}

std::uint16_t inputs_named(const std::vector<std::string>& names, const char* option)
{
    unsigned bits = 0;
    for (const std::string& name : names) {
        const std::uint16_t bit = input_named(name);
        if (bit == 0) {
            throw InputError{
                fmt::format("{} {}: is none of x, y, z, probe, door, hold, start, reset, at-speed",
                            option, name)};
        }
        bits |= bit;
    }
    return static_cast<std::uint16_t>(bits);
}

}  // namespace cusp::simulate
