// Parts of a program that run on their own, so that the times of a long program are found on all
// cores.
//
//     for (const ProgramPart& part : program_parts(program, 100)) {
//         LineSource source = part_source("the program", program, part);
//         ...                       // run it; count the ticks on lines [first_counted, end_counted)
//     }
//
// A part begins with the tool at rest, a stretch before the lines that it is counted for: by then
// the tool moves as in the whole program. The places where parts begin depend only on the program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host_tools/controller/dialect/line_source.hpp"

namespace cusp::simulate {

struct ProgramPart {
    // Lines that bring the machine to the place and modal state at `begin`; none for the first part.
    std::string head;
    std::uint32_t head_lines{0};
    std::size_t begin{0};         // offset in the program, bytes: of the line `first_line`
    std::uint32_t first_line{1};  // from 1
    std::uint32_t first_counted{1};
    std::uint32_t end_counted{
        0};             // of the next part's lines the first; 0: the part goes to the end
    double seconds{0};  // a rough estimate

    // Number in the program of a line of the part; 0 for lines of the head.
    std::uint32_t line_of(std::uint32_t line) const
    {
        return line <= head_lines ? 0 : line - head_lines + first_line - 1;
    }
};

// At least one part. Parts begin where the tool lifts, or, where it does not lift for long, at any
// line whose modal state a few words restore. No part begins behind words that move the machine by
// themselves ($ commands, probes), that change stored offsets, or that the interpreter refuses.
//
//   least  s: parts are about this long, by feeds alone
//
// Cost: each line is read once, without motion.
std::vector<ProgramPart> program_parts(std::string_view program, double least);

// The lines of a part and all that follow it. The program and the part must outlive the source.
dialect::LineSource part_source(std::string name,
                                std::string_view program,
                                const ProgramPart& part);

}  // namespace cusp::simulate
