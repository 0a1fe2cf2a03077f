// Checks the characters of a job file before TOML is parsed.
#pragma once

#include <string>

namespace cusp::import {

// Characters beyond ASCII may occur in strings and comments only: unquoted TOML keys and
// values have none, and toml++ 3.3 aborts where one follows a value.
//
// Throws InputError with the line. A byte order mark at the start is allowed.
void check_plain_text(const std::string& text, const std::string& file);

}  // namespace cusp::import
