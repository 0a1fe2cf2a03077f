// Interprets each line with gcode::Interpreter.
#include "host_tools/judge/view/program_reading.hpp"

#include <algorithm>
#include <cctype>

#include "firmware/gcode/interpreter.hpp"
#include "host_tools/controller/dialect/line_source.hpp"
#include "host_tools/controller/dialect/program_lines.hpp"
#include "host_tools/controller/dialect/refusal.hpp"

#include "fmt/format.h"

namespace cusp::view {

using dialect::bare_line;
using dialect::LineSource;
using dialect::Refusal;
using dialect::refusal;

namespace {

constexpr std::size_t kMostSections = 255;

// The text of the first comment, without its delimiters.
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
        ended_ = ended_ || end_line_.at(line);
        const std::string words = bare_line(line);
        note_comment(line, words.empty(), number);
        std::uint8_t rapid = 0;
        if (!ended_ && !words.empty() && words.front() != '$') {
            begun_ = true;
            rapid = execute(line, words, number) ? 1 : 0;
        }
        reading_.rapid.push_back(rapid);
        reading_.section.push_back(static_cast<std::uint8_t>(reading_.sections.size() - 1));
    }

private:
    // True if the line's moves are rapid.
    bool execute(const std::string& line, const std::string& words, std::uint64_t number)
    {
        const Status status = interpreter_.execute(words, static_cast<std::uint32_t>(number));
        if (!status) {
            refuse(line, number, static_cast<int>(status.error()));
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

    void refuse(const std::string& line, std::uint64_t number, int code)
    {
        ++reading_.refused_count;
        if (reading_.refused.size() < ProgramReading::kMostRefused) {
            Refusal found = refusal(code, line);
            // The whole line where no single word is wrong.
            const std::size_t end = found.end > found.begin ? found.end : line.size();
            reading_.refused.push_back({number, found.begin, end, code, std::move(found.text)});
        }
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
    dialect::EndLine end_line_;
};

}  // namespace

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
