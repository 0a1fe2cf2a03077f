// Refusal: which word of a line the controller refuses, and what that word is elsewhere.
//
//   refusal(20, "G1 X20 E1.5").text
//     a G or M word is not supported: E1.5 in "G1 X20 E1.5": E drives the extruder of a 3-D printer
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cusp::dialect {

struct Refusal {
    // The word that makes the line wrong: bytes [begin, end) of the line, none where no single word
    // does.
    std::size_t begin;
    std::size_t end;
    // What Grbl's documents say of the code, the word, the line, and what the word means in the
    // dialects that know it.
    std::string text;
};

//   code  Grbl's number of the error, of a line that a controller of this dialect has refused
//   line  as the program has it; empty where it is not known
Refusal refusal(int code, std::string_view line);

}  // namespace cusp::dialect
