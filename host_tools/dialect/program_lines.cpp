// Stripping of comments.
#include "host_tools/dialect/program_lines.hpp"

namespace cusp::dialect {
namespace {

constexpr std::size_t kMostDigits = 7;  // of a line number, as Grbl has it
constexpr std::uint64_t kMostNumber = 9'999'999;
constexpr std::size_t kLongestSent = 255;  // that the controller takes

bool is_digit(char character) { return character >= '0' && character <= '9'; }

}  // namespace

std::string numbered_line(std::string_view uncovered, std::uint64_t number)
{
    const std::string as_it_is{uncovered};
    if (uncovered.empty() || uncovered.front() == '$' || number > kMostNumber) {
        return as_it_is;
    }
    std::string words;
    for (std::size_t i = 0; i < uncovered.size(); ++i) {
        if (uncovered[i] != 'N' && uncovered[i] != 'n') {
            words.push_back(uncovered[i]);
            continue;
        }
        std::size_t digits = 0;
        while (i + 1 + digits < uncovered.size() && is_digit(uncovered[i + 1 + digits])) {
            ++digits;
        }
        const std::size_t end = i + 1 + digits;
        if (digits == 0 || digits > kMostDigits ||
            (end < uncovered.size() && uncovered[end] == '.')) {
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
    std::string uncovered;
    bool in_comment = false;
    for (const char character : line) {
        if (in_comment) {
            in_comment = character != ')';
        } else if (character == '(') {
            in_comment = true;
        } else if (character == ';') {
            break;
        } else if (character != ' ' && character != '\t') {
            uncovered.push_back(character);
        }
    }
    return uncovered == "%" ? std::string{} : uncovered;
}

std::optional<ProgramLine> ProgramLines::next()
{
    while (const auto line = source_.next()) {
        std::string uncovered = bare_line(*line);
        if (!uncovered.empty()) {
            return ProgramLine{source_.line_number(), std::move(uncovered)};
        }
    }
    return std::nullopt;
}

}  // namespace cusp::dialect
