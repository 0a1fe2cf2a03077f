// The words of this project's dialect that stock Grbl 1.1 refuses.
//
//     stock_grbl_refusal("G64 P0.02").code  // 20: not supported
//
// The source is Grbl's documents (the table of G-codes, error_codes_en_US.csv) and the order in
// which its reader checks a line. Mist (M7) and parking (M56) are build options that the released
// Grbl lacks.
#pragma once

#include <string>
#include <string_view>

#include "firmware/gcode/interpreter.hpp"

namespace cusp::dialect {

struct StockGrblRefusal {
    int code{0};       // Grbl's error; 0: it takes the line
    std::string word;  // the word that is wrong; empty where no single one is
};

// True if Grbl's reader refuses the line for its words: letters, numbers, groups, repeated and
// unused words, its own limits. Errors that depend on the state of the machine, such as a feed that
// is not set, are found with the same numbers by our own interpreter.
//
//   line  as the program has it
StockGrblRefusal stock_grbl_refusal(std::string_view line);

// The same with arcs, for which Grbl wants axis words and radii that agree more closely than ours.
//
//   before  state and position before the line, which has fetched all of its actions
StockGrblRefusal stock_grbl_refusal(std::string_view line, const gcode::Interpreter& before);

}  // namespace cusp::dialect
