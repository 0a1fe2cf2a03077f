// Settings files: Grbl's own lines, `$100=800.000`, one a line.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/settings.hpp"

namespace cusp::simulate {

// The default settings, changed by the file. Blank lines are ignored, and so is text after the
// value in parentheses or after ';' or '#'.
//
// Errors: InputError with file, line, setting, value and limit if the file cannot be read, a line
// is no setting, a value is out of range, or settings contradict each other.
machine::Settings read_settings_file(const std::string& file);
// As above, of a text; `name` is for messages.
machine::Settings settings_of_text(const std::string& text, const std::string& name);

// All settings as a file.
std::string settings_text(const machine::Settings& settings);

// The lines `$N=v`, without line ends, that change the defaults to these settings.
std::vector<std::string> settings_commands(const machine::Settings& settings);

}  // namespace cusp::simulate
