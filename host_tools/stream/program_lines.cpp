// Stripping of comments.
#include "host_tools/stream/program_lines.hpp"

namespace cusp::host {

std::string bare_line(std::string_view line)
{
    const std::size_t first = line.find_first_not_of(" \t");
    if (first != std::string_view::npos && line[first] == '$') {
        return std::string{line.substr(first)};
    }
    std::string bare;
    bool in_comment = false;
    for (const char character : line) {
        if (in_comment) {
            in_comment = character != ')';
        } else if (character == '(') {
            in_comment = true;
        } else if (character == ';') {
            break;
        } else if (character != ' ' && character != '\t') {
            bare.push_back(character);
        }
    }
    return bare == "%" ? std::string{} : bare;
}

std::optional<ProgramLine> ProgramLines::next()
{
    while (const auto line = source_.next()) {
        std::string bare = bare_line(*line);
        if (!bare.empty()) {
            return ProgramLine{source_.line_number(), std::move(bare)};
        }
    }
    return std::nullopt;
}

}  // namespace cusp::host
