// Stripping of comments.
#include "host_tools/controller/dialect/program_lines.hpp"

#include <algorithm>

#include "host_tools/controller/dialect/leading_number.hpp"

namespace cusp::dialect {
namespace {

constexpr std::size_t kMostDigits = 7;  // of a line number in Grbl
constexpr std::uint64_t kMostNumber = 9'999'999;
constexpr std::size_t kLongestSent = 255;  // that the controller accepts

// Marks of tapes and of other systems' files: no controller reads them.
bool is_control(char character)
{
    return static_cast<unsigned char>(character) < ' ' || character == '\x7f';
}

bool is_digit(char character) { return character >= '0' && character <= '9'; }

// The place after a point and the digits behind it; `place` where there is no point.
std::size_t after_decimals(std::string_view line, std::size_t place)
{
    if (place >= line.size() || line[place] != '.') {
        return place;
    }
    do {
        ++place;
    } while (place < line.size() && is_digit(line[place]));
    return place;
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view line)
{
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    return line.substr(0, kMark.size()) == kMark ? line.substr(kMark.size()) : line;
}

std::string numbered_line(std::string_view line, std::uint64_t number)
{
    const std::string as_it_is{line};
    if (line.empty() || line.front() == '$' || number > kMostNumber) {
        return as_it_is;
    }
    std::string words;
    bool had_number = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] != 'N' && line[i] != 'n') {
            words.push_back(line[i]);
            continue;
        }
        if (had_number) {
            return as_it_is;  // two lines in one: the controller refuses it
        }
        had_number = true;
        std::size_t digits = 0;
        while (i + 1 + digits < line.size() && is_digit(line[i + 1 + digits])) {
            ++digits;
        }
        const std::size_t whole_end = i + 1 + digits;
        if (digits == 0 || digits > kMostDigits) {
            return as_it_is;
        }
        const std::size_t end = after_decimals(line, whole_end);
        if (end < line.size() && line[end] == '.') {
            return as_it_is;
        }
        i = end - 1;
    }
    std::string numbered = "N" + std::to_string(number) + words;
    return numbered.size() <= kLongestSent ? numbered : as_it_is;
}

std::string bare_line(std::string_view line)
{
    line = without_byte_order_mark(line);
    const std::size_t first = line.find_first_not_of(" \t");
    if (first != std::string_view::npos && line[first] == '$') {
        std::string command{line.substr(first)};
        command.erase(std::remove_if(command.begin(), command.end(), is_control), command.end());
        return command;
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
        } else if (character != ' ' && !is_control(character)) {
            words.push_back(character);
        }
    }
    return words == "%" ? std::string{} : words;
}

std::optional<std::size_t> realtime_byte(std::string_view words)
{
    const auto* const found = std::find_if(words.begin(), words.end(), [](char character) {
        return character == '?' || character == '!' || character == '~' ||
               static_cast<unsigned char>(character) >= 0x80;
    });
    return found == words.end() ? std::nullopt
                                : std::optional{static_cast<std::size_t>(found - words.begin())};
}

bool ends_program(std::string_view words)
{
    if (!words.empty() && words.front() == '$') {
        return false;
    }
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == 'M' || words[i] == 'm') {
            const auto number = leading_number(words.substr(i + 1));
            if (number && (number->value == 2 || number->value == 30)) {
                return true;
            }
        }
    }
    return false;
}

bool EndLine::at(std::string_view line)
{
    const auto blank = [](char c) {
        return c == ' ' || is_control(c);
    };
    line = without_byte_order_mark(line);
    const auto* const first = std::find_if_not(line.begin(), line.end(), blank);
    if (first == line.end()) {
        return false;
    }
    const bool mark = *first == '%' && std::all_of(first + 1, line.end(), blank);
    if (!begun_) {
        begun_ = true;
        marked_ = mark;
        return false;
    }
    return marked_ && mark;
}

std::optional<ProgramLine> ProgramLines::next()
{
    while (!ended_) {
        const auto line = source_.next();
        if (!line || end_line_.at(*line)) {
            ended_ = true;
            break;
        }
        std::string words = bare_line(*line);
        if (!words.empty()) {
            ended_ = ends_program(words);
            return ProgramLine{source_.line_number(), std::move(words)};
        }
    }
    return std::nullopt;
}

}  // namespace cusp::dialect
