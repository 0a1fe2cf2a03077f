// ProgramLines: the lines of a program as sent, without comments and blanks.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "host_tools/dialect/line_source.hpp"

namespace cusp::dialect {

// The line without comments, blanks and tape markers (%); $ commands are unchanged.
std::string bare_line(std::string_view line);

// bare_line() with `number` as its only N word, so that the controller's reports name the line of
// the file. $ commands and lines with a malformed N word are unchanged.
std::string numbered_line(std::string_view line, std::uint64_t number);

struct ProgramLine {
    std::uint64_t number;  // in the file, from 1
    std::string text;      // as bare_line(), without line end
};

class ProgramLines {
public:
    // Throws InputError, as next() does.
    explicit ProgramLines(const std::string& file) : source_{file} {}

    // The next line that is not empty.
    std::optional<ProgramLine> next();

    double progress() const { return source_.progress(); }
    const std::string& file() const { return source_.name(); }

private:
    LineSource source_;
};

}  // namespace cusp::dialect
