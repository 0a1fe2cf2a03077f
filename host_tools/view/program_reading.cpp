// Reads along with gcode::Interpreter; of a refused line the word is sought without which it is taken.
#include "host_tools/view/program_reading.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "firmware/gcode/interpreter.hpp"
#include "host_tools/dialect/answer.hpp"
#include "host_tools/dialect/line_source.hpp"
#include "host_tools/dialect/program_lines.hpp"

#include "fmt/format.h"

namespace cusp::view {

using dialect::bare_line;
using dialect::error_text;
using dialect::LineSource;

namespace {

constexpr std::size_t kMostSections = 255;

bool is_number(std::string_view text)
{
    std::size_t digits = 0;
    std::size_t points = 0;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const auto c = static_cast<unsigned char>(text[k]);
        if (std::isdigit(c) != 0) {
            ++digits;
        } else if (c == '.') {
            ++points;
        } else if (k > 0 || (c != '+' && c != '-')) {
            return false;
        }
    }
    return digits > 0 && points < 2;
}

// The text of the first comment, without its marks.
std::string comment_of(const std::string& line)
{
    const std::size_t open = line.find_first_of("(;");
    if (open == std::string::npos) {
        return "";
    }
    const std::size_t close = line[open] == '(' ? line.find(')', open) : std::string::npos;
    const std::size_t begin = line.find_first_not_of(" \t", open + 1);
    return begin == std::string::npos || begin >= close
               ? ""
               : line.substr(begin, close == std::string::npos ? close : close - begin);
}

class LineReader {
public:
    explicit LineReader(ProgramReading& reading) : reading_{reading}
    {
        reading_.rapid.push_back(0);
        reading_.section.push_back(0);
        reading_.sections.push_back({0, 0, ""});
    }

    void read(const std::string& line, std::uint64_t number)
    {
        const std::string bare = bare_line(line);
        note_comment(line, bare.empty(), number);
        std::uint8_t rapid = 0;
        if (!ended_ && !bare.empty() && bare.front() != '$') {
            begun_ = true;
            rapid = execute(line, bare, number) ? 1 : 0;
        }
        reading_.rapid.push_back(rapid);
        reading_.section.push_back(static_cast<std::uint8_t>(reading_.sections.size() - 1));
    }

private:
    // Whether the line's moves are rapid.
    bool execute(const std::string& line, const std::string& bare, std::uint64_t number)
    {
        const gcode::Interpreter before = interpreter_;
        const Status status = interpreter_.execute(bare, static_cast<std::uint32_t>(number));
        if (!status) {
            refuse(line, number, static_cast<int>(status.error()), before);
            return false;
        }
        bool rapid = false;
        gcode::Action action;
        while (interpreter_.next(action)) {
            if (const auto* move = std::get_if<path::Move>(&action)) {
                rapid = rapid || move->kind == path::MoveKind::kRapid;
            }
            ended_ = ended_ || std::holds_alternative<gcode::ProgramEnd>(action);
        }
        const int tool = interpreter_.modal().tool;
        if (tool != reading_.sections.back().tool) {
            begin_section(number, tool, title_.empty() ? fmt::format("T{}", tool) : title_);
        }
        return rapid;
    }

    void refuse(const std::string& line,
                std::uint64_t number,
                int code,
                const gcode::Interpreter& before)
    {
        ++reading_.refused_count;
        if (reading_.refused.size() < ProgramReading::kMostRefused) {
            const WordPlace word = wrong_word(line, before);
            reading_.refused.push_back(
                {number, word.begin, word.end, code, std::string{error_text(code)}});
        }
    }

    // The word that is no word; else the one without which the line is taken; else the last of the
    // shortest beginning that is refused.
    static WordPlace wrong_word(const std::string& line, const gcode::Interpreter& before)
    {
        const std::vector<WordPlace> words = words_of(line);
        const auto taken = [&](const std::string& text) {
            gcode::Interpreter copy = before;
            return static_cast<bool>(copy.execute(bare_line(text), 1));
        };
        for (const WordPlace& word : words) {
            if (!is_number(
                    std::string_view{line}.substr(word.begin + 1, word.end - word.begin - 1))) {
                return word;
            }
        }
        constexpr std::size_t kMostTried = 64;
        for (std::size_t k = std::min(words.size(), kMostTried); k-- > 0;) {
            std::string without = line;
            std::fill(without.begin() + static_cast<std::ptrdiff_t>(words[k].begin),
                      without.begin() + static_cast<std::ptrdiff_t>(words[k].end), ' ');
            if (taken(without)) {
                return words[k];
            }
        }
        for (std::size_t k = 0; k < std::min(words.size(), kMostTried); ++k) {
            if (!taken(line.substr(0, words[k].end))) {
                return words[k];
            }
        }
        return {0, line.size()};
    }

    void note_comment(const std::string& line, bool alone, std::uint64_t number)
    {
        const std::string text = comment_of(line);
        if (text.empty()) {
            return;
        }
        constexpr std::size_t kMostHeader = 40;
        if (!begun_ && alone && reading_.header.size() < kMostHeader) {
            reading_.header.push_back(text);
        }
        std::string lower = text.substr(0, 16);
        std::transform(lower.begin(), lower.end(), lower.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (lower.rfind("tool ", 0) == 0) {
            title_ = text;
        } else if (begun_ && (lower.rfind("operation", 0) == 0 || lower.rfind("section", 0) == 0)) {
            begin_section(number, interpreter_.modal().tool, text);
        }
    }

    void begin_section(std::uint64_t number, int tool, std::string title)
    {
        if (reading_.sections.size() < kMostSections) {
            reading_.sections.push_back({number, tool, std::move(title)});
        }
        title_.clear();
    }

    ProgramReading& reading_;
    gcode::Interpreter interpreter_;
    std::string title_;  // of the next section
    bool begun_{false};
    bool ended_{false};
};

}  // namespace

std::vector<WordPlace> words_of(const std::string& line)
{
    std::vector<WordPlace> words;
    bool in_comment = false;
    bool open = false;  // the last word may go on
    for (std::size_t k = 0; k < line.size(); ++k) {
        const auto c = static_cast<unsigned char>(line[k]);
        if (in_comment) {
            in_comment = c != ')';
        } else if (c == '(') {
            in_comment = true;
        } else if (c == ';') {
            break;
        } else if (c == ' ' || c == '\t' || (c == '/' && words.empty())) {
            continue;
        } else if (open && (std::isdigit(c) != 0 || c == '.' || c == '-' || c == '+')) {
            words.back().end = k + 1;
        } else {
            words.push_back({k, k + 1});
            open = std::isalpha(c) != 0;
        }
    }
    return words;
}

ProgramReading read_program_lines(const std::string& file)
{
    ProgramReading reading;
    LineReader reader{reading};
    LineSource source{file};
    while (const auto line = source.next()) {
        reader.read(*line, source.line_number());
        reading.text += *line;
        reading.text += '\n';
    }
    reading.lines = source.line_number();
    return reading;
}

}  // namespace cusp::view
