// ProgramLines: the lines of a program as they go over the wire: without comments and blanks.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "host_tools/simulate/line_source.hpp"

namespace cusp::host {

// What is left of a line without comments, blanks and the % of tapes; $ commands are left alone.
std::string bare_line(std::string_view line);

struct ProgramLine {
    std::uint64_t number;  // in the file, from 1
    std::string text;      // bare, without line end
};

class ProgramLines {
public:
    // Throws InputError, as next() does.
    explicit ProgramLines(const std::string& file) : source_{file} {}

    // The next line that says something.
    std::optional<ProgramLine> next();

    double progress() const { return source_.progress(); }
    const std::string& file() const { return source_.name(); }

private:
    LineSource source_;
};

}  // namespace cusp::host
