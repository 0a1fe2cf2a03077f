// Gerber files as their commands: words that end in *, and extended commands between %.
#pragma once

#include <string>
#include <vector>

namespace cusp::import {

struct GerberCommand {
    std::vector<std::string> words;  // without their *; more than one in a macro alone
    int line{};                      // of the file, of its begin
    bool extended{};                 // between %
};

// Line ends within words are left out.
//
// Errors: InputError with the line: an extended command that does not end, bytes that are no text.
std::vector<GerberCommand> gerber_commands(const std::string& file, const std::string& text);

}  // namespace cusp::import
