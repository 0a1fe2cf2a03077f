// Settings as text: Grbl's own lines, `$100=800.000`, one a line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "firmware/machine/settings.hpp"
#include "host_tools/dialect/line_source.hpp"

namespace cusp::program_run {

// Why settings are refused.
struct SettingsRefusal {
    std::uint64_t line;  // from 1; 0: no line of the text
    std::string text;    // names setting, value and limit
};

// Puts what the lines say into `settings`. Blank lines, and text after the value in parentheses or after
// ';' or '#', are passed over.
//
// Refused: a line that is no setting, a value out of range, settings that can't be used together.
std::optional<SettingsRefusal> read_settings(dialect::LineSource& source,
                                             machine::Settings& settings);

}  // namespace cusp::program_run
