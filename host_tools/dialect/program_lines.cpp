// Stripping of comments.
#include "host_tools/dialect/program_lines.hpp"

namespace cusp::dialect {
namespace {

constexpr std::size_t kMostDigits = 7;  // of a line number in Grbl
constexpr std::uint64_t kMostNumber = 9'999'999;
constexpr std::size_t kLongestSent = 255;  // that the controller accepts

bool is_digit(char character) { return character >= '0' && character <= '9'; }

}  // namespace

std::string numbered_line(std::string_view line, std::uint64_t number)
{
    const std::string as_it_is{line};
    if (line.empty() || line.front() == '$' || number > kMostNumber) {
        return as_it_is;
    }
    std::string words;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] != 'N' && line[i] != 'n') {
            words.push_back(line[i]);
            continue;
        }
        std::size_t digits = 0;
        while (i + 1 + digits < line.size() && is_digit(line[i + 1 + digits])) {
            ++digits;
        }
        const std::size_t end = i + 1 + digits;
        if (digits == 0 || digits > kMostDigits || (end < line.size() && line[end] == '.')) {
            return as_it_is;
        }
        i += digits;
    }
    std::string numbered = "N" + std::to_string(number) + words;
    return numbered.size() <= kLongestSent ? numbered : as_it_is;
}

std::string bare_line(std::string_view line)
{
    const std::size_t first = line.find_first_not_of(" \t");
    if (first != std::string_view::npos && line[first] == '$') {
        return std::string{line.substr(first)};
    }
    std::string words;
    bool in_comment = false;
    for (const char character : line) {
        if (in_comment) {
            in_comment = character != ')';
        } else if (character == '(') {
            in_comment = true;
        } else if (character == ';') {
            break;
        } else if (character != ' ' && character != '\t') {
            words.push_back(character);
        }
    }
    return words == "%" ? std::string{} : words;
}

std::optional<ProgramLine> ProgramLines::next()
{
    while (const auto line = source_.next()) {
        std::string words = bare_line(*line);
        if (!words.empty()) {
            return ProgramLine{source_.line_number(), std::move(words)};
        }
    }
    return std::nullopt;
}

}  // namespace cusp::dialect
