// What may stand in a job file before any TOML is read from it.
#pragma once

#include <string>

namespace cusp::import {

// Letters beyond ASCII belong into strings and comments only: in TOML no key or value has others,
// and toml++ 3.3 runs into a place it calls unreachable where one follows a value.
//
// Throws InputError with the line. A byte order mark at the start is no letter.
void check_plain_text(const std::string& text, const std::string& file);

}  // namespace cusp::import
