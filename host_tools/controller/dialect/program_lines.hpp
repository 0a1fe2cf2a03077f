// ProgramLines: the lines of a program as sent, without comments and blanks, up to its end.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "host_tools/controller/dialect/line_source.hpp"

namespace cusp::dialect {

// The line without the mark that some editors put before a UTF-8 text.
std::string_view without_byte_order_mark(std::string_view line);

// The line without comments, blanks, control characters, byte order mark and tape markers (%); $
// commands keep their blanks.
std::string bare_line(std::string_view line);

// The first byte that a controller takes out of a line at once: ?, ! and ~ ask, hold and resume, and
// those above 0x7F override, open the door or reset. No value where the line can be sent.
//
// words  as bare_line()
std::optional<std::size_t> realtime_byte(std::string_view words);

// True if the line ends the program when it is run: M2 or M30. Wrong lines are not looked for.
//
// words  as bare_line()
bool ends_program(std::string_view words);

// Finds the % that ends a program: the second, where the first line is one.
class EndLine {
public:
    // For every line of the file in order. True if the program has ended before this line.
    bool at(std::string_view line);

private:
    bool begun_{false};
    bool marked_{false};  // by a % in the first line that is not blank
};

// bare_line() with `number` as its only N word, so that the controller's reports name the line of
// the file. $ commands and lines with a malformed N word, or with two of them, are unchanged.
std::string numbered_line(std::string_view line, std::uint64_t number);

struct ProgramLine {
    std::uint64_t number;  // in the file, from 1
    std::string text;      // as bare_line(), without line end
};

class ProgramLines {
public:
    // Throws InputError, as next() does.
    explicit ProgramLines(const std::string& file) : source_{file} {}

    // The next line that is not empty. None after M2 or M30, nor from the second % on.
    std::optional<ProgramLine> next();

    double progress() const { return source_.progress(); }
    const std::string& file() const { return source_.name(); }

private:
    LineSource source_;
    EndLine end_line_;
    bool ended_{false};
};

}  // namespace cusp::dialect
