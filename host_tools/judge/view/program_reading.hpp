// The lines of a program as the controller's interpreter reads them: rapid lines, tools, sections,
// and refused lines with the wrong word.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cusp::view {

struct RefusedLine {
    std::uint64_t line;  // from 1
    std::size_t begin;   // of the word in the line, bytes
    std::size_t end;
    int code;  // Grbl's
    std::string text;
};

// Starts at a line with a tool change, or at a comment that starts an operation.
struct ProgramSection {
    std::uint64_t line;
    int tool;
    std::string title;
};

struct ProgramReading {
    std::string text;  // the program with \n as line ends
    std::uint64_t lines{0};
    std::vector<std::uint8_t> rapid;    // of line k at k; 1: its moves are rapid
    std::vector<std::uint8_t> section;  // of line k at k: its index in `sections`, at most 255
    std::vector<ProgramSection> sections;
    std::vector<RefusedLine> refused;  // the first kMostRefused of them
    std::uint64_t refused_count{0};
    std::vector<std::string> header;  // the comments before the first command

    static constexpr std::size_t kMostRefused = 1000;
};

// A refused line is skipped. Throws InputError where the file can't be read.
ProgramReading read_program_lines(const std::string& file);

}  // namespace cusp::view
