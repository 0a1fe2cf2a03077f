// Refusal: the word of a line that the controller refuses, and its meaning in other dialects.
//
//   refusal(20, "G1 X20 E1.5").text
//     a G or M word is not supported: E1.5 in "G1 X20 E1.5": E drives the extruder of a 3-D printer
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cusp::dialect {

struct Refusal {
    // The wrong word: bytes [begin, end) of the line; empty where no single word is wrong.
    std::size_t begin;
    std::size_t end;
    // Grbl's text of the code, the word, the line, and the meaning of the word in other dialects.
    std::string text;
};

//   code  Grbl's error number, from a controller of this dialect
//   line  the refused line as in the program; empty where it is unknown
Refusal refusal(int code, std::string_view line);

// The text of a refusal whose word is known: what Grbl's documents say of the code, the word, the
// line.
std::string refusal_text(int code, std::string_view word, std::string_view line);

}  // namespace cusp::dialect
