// Refusal: which word of a line the controller refuses, and what that word is elsewhere.
//
//   refusal_text(20, "G1 X20 E1.5")
//     a G or M word is not supported: E1.5 in "G1 X20 E1.5": E drives the extruder of a 3-D printer
#pragma once

#include <string>
#include <string_view>

namespace cusp::dialect {

// The word that makes the line wrong, as it is written there; empty where no single word does.
//
//   code  Grbl's number of the error, of a line that a controller of this dialect has refused
std::string refused_word(int code, std::string_view line);

// What Grbl's documents say of the code, the refused word, the line, and what the word means in
// the dialects that know it.
std::string refusal_text(int code, std::string_view line);

}  // namespace cusp::dialect
