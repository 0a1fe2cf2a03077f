// Reading and writing of settings files.
#include "host_tools/simulate/settings_file.hpp"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <string_view>

#include "host_tools/dialect/line_source.hpp"
#include "host_tools/input_error/input_error.hpp"

namespace cusp::simulate {

using dialect::LineSource;

namespace {

using machine::Settings;

std::string_view trimmed(std::string_view text)
{
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

struct Assignment {
    std::uint32_t number;
    double value;
};

template <class Number>
bool read_number(std::string_view text, Number& number)
{
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
    return failed == std::errc{} && end == text.data() + text.size();
}

// Throws InputError where the text is no `$N=v`.
Assignment parse_assignment(std::string_view text, const std::string& place)
{
    const std::size_t equals = text.find('=');
    Assignment assignment{};
    if (text.front() != '$' || equals == std::string_view::npos ||
        !read_number(trimmed(text.substr(1, equals - 1)), assignment.number)) {
        throw InputError{fmt::format("{}: '{}' is no setting such as $100=800.000", place, text)};
    }
    const std::string_view value = trimmed(text.substr(equals + 1));
    if (!read_number(value, assignment.value) || !std::isfinite(assignment.value)) {
        throw InputError{
            fmt::format("{}: ${}: '{}' is no number", place, assignment.number, value)};
    }
    return assignment;
}

const machine::SettingEntry* find_entry(std::uint32_t number)
{
    for (std::size_t i = 0; i < machine::kSettingCount; ++i) {
        if (machine::setting_entry(i).number == number) {
            return &machine::setting_entry(i);
        }
    }
    return nullptr;
}

void put(Settings& settings, const Assignment& assignment, const std::string& place)
{
    const machine::SettingEntry* entry = find_entry(assignment.number);
    if (entry == nullptr) {
        throw InputError{fmt::format("{}: there is no setting ${}", place, assignment.number)};
    }
    if (settings.put(assignment.number, static_cast<float>(assignment.value))) {
        throw InputError{fmt::format("{}: ${}={:g} is out of range: {:g} to {:g}", place,
                                     assignment.number, assignment.value, entry->least,
                                     entry->most)};
    }
}

std::string fault_text(const machine::SettingFault& fault)
{
    if (fault.error == Error::kSoftLimitError) {
        return "$20=1, soft limits, needs homing, $22=1";
    }
    if (fault.error == Error::kMaxStepRateExceeded) {
        return fmt::format(
            "${} and ${} ask for a step every {:.3f} us; $0 allows one every {:.3f} us at most",
            fault.first, fault.second, fault.amount, fault.limit);
    }
    return fmt::format("${} and ${} ask for a filter of {:.0f} ms; the limit is {:.0f} ms",
                       fault.first, fault.second, 1000.0 * static_cast<double>(fault.amount),
                       1000.0 * static_cast<double>(fault.limit));
}

std::string value_text(const Settings& settings, std::size_t index)
{
    return fmt::format("{:.{}f}", settings.value_at(index),
                       int{machine::setting_entry(index).decimals});
}

}  // namespace

Settings read_settings_file(const std::string& file)
{
    LineSource source{file};
    Settings settings;
    std::map<std::uint32_t, std::uint64_t> lines;
    // Homing is set first: without it there are no soft limits.
    std::vector<std::pair<Assignment, std::string>> assignments;
    while (const auto line = source.next()) {
        const std::string_view text =
            trimmed(std::string_view{*line}.substr(0, line->find_first_of("(;#")));
        if (text.empty()) {
            continue;
        }
        const std::string place = fmt::format("{}:{}", file, source.line_number());
        const Assignment assignment = parse_assignment(text, place);
        lines[assignment.number] = source.line_number();
        constexpr std::uint32_t kHoming = 22;
        const auto where = assignment.number == kHoming ? assignments.begin() : assignments.end();
        assignments.insert(where, {assignment, place});
    }
    for (const auto& [assignment, place] : assignments) {
        put(settings, assignment, place);
    }
    if (const auto fault = settings.find_fault()) {
        std::uint64_t line = 0;
        // $0 says how close steps may come.
        for (const std::uint16_t number : {fault->first, fault->second, std::uint16_t{0}}) {
            const auto found = lines.find(number);
            line = found == lines.end() ? line : std::max(line, found->second);
        }
        const std::string place = line == 0 ? file : fmt::format("{}:{}", file, line);
        throw InputError{place + ": " + fault_text(*fault)};
    }
    return settings;
}

std::string settings_text(const Settings& settings)
{
    std::string text;
    for (std::size_t i = 0; i < machine::kSettingCount; ++i) {
        text += fmt::format("${}={}\n", machine::setting_entry(i).number, value_text(settings, i));
    }
    return text;
}

std::vector<std::string> settings_commands(const Settings& settings)
{
    const Settings standard;
    std::vector<std::string> commands;
    for (std::size_t i = 0; i < machine::kSettingCount; ++i) {
        if (settings.value_at(i) != standard.value_at(i)) {
            commands.push_back(
                fmt::format("${}={}", machine::setting_entry(i).number, value_text(settings, i)));
        }
    }
    return commands;
}

}  // namespace cusp::simulate
