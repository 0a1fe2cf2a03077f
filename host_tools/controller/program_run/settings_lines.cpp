// Parses settings.
#include "host_tools/controller/program_run/settings_lines.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "host_tools/controller/dialect/leading_number.hpp"

namespace cusp::program_run {

using dialect::LineSource;

namespace {

using machine::Settings;

struct Assignment {
    std::uint32_t number;
    double value;
    std::uint64_t line;
};

std::string_view trimmed(std::string_view text)
{
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// std::printf into a string of at most 255 characters.
template <class... Values>
std::string text_of(const char* format, Values... values)
{
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

// N of `$N`; no value where it is malformed.
std::optional<std::uint32_t> setting_number(std::string_view name)
{
    if (name.empty() || name.front() != '$') {
        return std::nullopt;
    }
    const std::string_view digits = trimmed(name.substr(1));
    std::uint32_t number = 0;
    const auto [end, failed] =
        std::from_chars(digits.data(), digits.data() + digits.size(), number);
    const bool whole = failed == std::errc{} && end == digits.data() + digits.size();
    return whole ? std::optional{number} : std::nullopt;
}

std::optional<SettingsRefusal> parse(std::string_view text,
                                     std::uint64_t line,
                                     Assignment& assignment)
{
    const std::size_t equals = text.find('=');
    const auto number =
        equals == std::string_view::npos ? std::nullopt : setting_number(text.substr(0, equals));
    if (!number) {
        return SettingsRefusal{line,
                               "'" + std::string{text} + "' is no setting such as $100=800.000"};
    }
    const std::string_view value = trimmed(text.substr(equals + 1));
    const auto found = dialect::leading_number(value);
    if (!found || found->size != value.size()) {
        return SettingsRefusal{
            line, "$" + std::to_string(*number) + ": '" + std::string{value} + "' is no number"};
    }
    assignment = {*number, found->value, line};
    return std::nullopt;
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

std::optional<SettingsRefusal> put(Settings& settings, const Assignment& assignment)
{
    const machine::SettingEntry* entry = find_entry(assignment.number);
    if (entry == nullptr) {
        return SettingsRefusal{assignment.line,
                               "there is no setting $" + std::to_string(assignment.number)};
    }
    if (settings.put(assignment.number, static_cast<float>(assignment.value))) {
        return SettingsRefusal{
            assignment.line,
            text_of("$%u=%g is out of range: %g to %g", unsigned{entry->number}, assignment.value,
                    static_cast<double>(entry->least), static_cast<double>(entry->most))};
    }
    return std::nullopt;
}

std::string fault_text(const machine::SettingFault& fault)
{
    const auto amount = static_cast<double>(fault.amount);
    const auto limit = static_cast<double>(fault.limit);
    if (fault.error == Error::kSoftLimitError) {
        return "$20=1, soft limits, needs homing, $22=1";
    }
    if (fault.error == Error::kMaxStepRateExceeded) {
        return text_of(
            "$%u and $%u ask for a step every %.3f us; $0 allows one every %.3f us at most",
            unsigned{fault.first}, unsigned{fault.second}, amount, limit);
    }
    return text_of("$%u and $%u ask for a filter of %.0f ms; the limit is %.0f ms",
                   unsigned{fault.first}, unsigned{fault.second}, 1000.0 * amount, 1000.0 * limit);
}

// A contradiction between settings, attributed to the last line that takes part in it.
std::optional<SettingsRefusal> refusal_together(const Settings& settings,
                                                const std::vector<Assignment>& assignments)
{
    const auto fault = settings.find_fault();
    if (!fault) {
        return std::nullopt;
    }
    std::map<std::uint32_t, std::uint64_t> last_line;
    for (const Assignment& assignment : assignments) {
        std::uint64_t& line = last_line[assignment.number];
        line = std::max(line, assignment.line);
    }
    std::uint64_t line = 0;
    // $0 is the least time between steps.
    for (const std::uint16_t number : {fault->first, fault->second, std::uint16_t{0}}) {
        line = std::max(line, last_line[number]);
    }
    return SettingsRefusal{line, fault_text(*fault)};
}

}  // namespace

std::optional<SettingsRefusal> read_settings(LineSource& source, Settings& settings)
{
    // Homing is set first: without it there are no soft limits.
    std::vector<Assignment> assignments;
    while (const auto line = source.next()) {
        const std::string_view text =
            trimmed(std::string_view{*line}.substr(0, line->find_first_of("(;#")));
        if (text.empty()) {
            continue;
        }
        Assignment assignment{};
        if (auto refusal = parse(text, source.line_number(), assignment)) {
            return refusal;
        }
        constexpr std::uint32_t kHoming = 22;
        const auto where = assignment.number == kHoming ? assignments.begin() : assignments.end();
        assignments.insert(where, assignment);
    }
    for (const Assignment& assignment : assignments) {
        if (auto refusal = put(settings, assignment)) {
            return refusal;
        }
    }
    return refusal_together(settings, assignments);
}

}  // namespace cusp::program_run
