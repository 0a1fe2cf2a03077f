// What a program says line by line, as the controller's own interpreter reads it: rapid lines, tools,
// sections, and the lines that it refuses with the word that is wrong.
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

// From this line on: another tool, or another operation by the program's own comments.
struct ProgramSection {
    std::uint64_t line;
    int tool;
    std::string title;
};

struct ProgramReading {
    std::string text;  // lines ended by \n, as they are counted
    std::uint64_t lines{0};
    std::vector<std::uint8_t> rapid;    // of line k at k; 1: its moves are rapid
    std::vector<std::uint8_t> section;  // of line k at k: its place in `sections`, 255 at most
    std::vector<ProgramSection> sections;
    std::vector<RefusedLine> refused;  // the first kMostRefused of them
    std::uint64_t refused_count{0};
    std::vector<std::string> header;  // the comments before the first command

    static constexpr std::size_t kMostRefused = 1000;
};

// A refused line is passed over, and what follows is read as if it were not there.
// Throws InputError where the file can't be read.
ProgramReading read_program_lines(const std::string& file);

}  // namespace cusp::view
