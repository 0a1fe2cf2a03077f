// One walk over the bytes.
#include "host_tools/job/import/gerber_text.hpp"

#include <utility>

#include "host_tools/base/input_error/input_error.hpp"

#include "fmt/format.h"

namespace cusp::import {

std::vector<GerberCommand> gerber_commands(const std::string& file, const std::string& text)
{
    std::vector<GerberCommand> commands;
    GerberCommand now{{}, 1, false};
    std::string word;
    int line = 1;
    for (const char c : text) {
        if (c == '\n') {
            ++line;
        } else if (c == '%') {
            if (now.extended && !word.empty()) {
                throw InputError(fmt::format("{} line {}: \"{}\" does not end in *", file, line,
                                             word.substr(0, 40)),
                                 {file, static_cast<std::uint64_t>(line)});
            }
            if (now.extended && !now.words.empty()) {
                commands.push_back(std::move(now));
            }
            now = {{}, line, !now.extended};
            word.clear();
        } else if (c == '*') {
            if (now.extended) {
                now.words.push_back(std::move(word));
            } else {
                commands.push_back({{std::move(word)}, now.line, false});
            }
            word = {};
            now.line = now.extended ? now.line : line;
        } else if (static_cast<unsigned char>(c) < ' ' && c != '\r' && c != '\t') {
            throw InputError(fmt::format("{} line {}: no Gerber file: it has the byte {}", file,
                                         line, static_cast<int>(static_cast<unsigned char>(c))),
                             {file, static_cast<std::uint64_t>(line)});
        } else if (c != '\r') {
            if (word.empty()) {
                now.line = now.extended && !now.words.empty() ? now.line : line;
            }
            word += c;
        }
    }
    if (now.extended) {
        throw InputError(
            fmt::format(
                "{} line {}: the extended command that begins here does not end: its % is missing",
                file, now.line),
            {file, static_cast<std::uint64_t>(now.line)});
    }
    return commands;
}

}  // namespace cusp::import
