// Settings files: Grbl's own lines, `$100=800.000`, one a line.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/settings.hpp"

namespace cusp::simulate {

// The default settings with what the file says. Blank lines, and text after the value in
// parentheses or after ';' or '#', are passed over.
//
// Throws InputError, naming file, line, setting, value and limit, where the file can't be read, a
// line is no setting, a value is out of range, or settings can't be used together.
machine::Settings read_settings_file(const std::string& file);

// All settings as a file.
std::string settings_text(const machine::Settings& settings);

// The lines `$N=v`, without line ends, that turn the defaults into these settings.
std::vector<std::string> settings_commands(const machine::Settings& settings);

}  // namespace cusp::simulate
