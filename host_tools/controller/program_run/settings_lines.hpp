// Settings as text in Grbl's format, `$100=800.000`, one on each line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "firmware/machine/settings.hpp"
#include "host_tools/controller/dialect/line_source.hpp"

namespace cusp::program_run {

// The reason why settings are refused.
struct SettingsRefusal {
    std::uint64_t line;  // from 1; 0: no line of the text
    std::string text;    // with setting, value and limit
};

// Changes `settings` by the lines. Ignores blank lines, and text after the value in parentheses or after ';' or '#'.
//
// Returns a refusal for a line that is no setting, a value out of range, or settings that contradict each other.
std::optional<SettingsRefusal> read_settings(dialect::LineSource& source,
                                             machine::Settings& settings);

}  // namespace cusp::program_run
