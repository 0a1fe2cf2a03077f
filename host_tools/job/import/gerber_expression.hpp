// Arithmetic in macros of Gerber files: +, -, x, /, parentheses, variables.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace cusp::import {

// By their numbers; those that are missing are 0.
using GerberVariables = std::map<int, double>;

// place  for messages
// Errors: InputError: malformed, a division by 0, more than 64 parentheses or signs deep.
double gerber_value(std::string_view text,
                    const GerberVariables& variables,
                    const std::string& place);

}  // namespace cusp::import
