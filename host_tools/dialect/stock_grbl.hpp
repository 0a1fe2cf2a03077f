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

namespace cusp::dialect {

struct StockGrblRefusal {
    int code{0};       // Grbl's error; 0: it takes the line
    std::string word;  // the word that is wrong; empty where no single one is
};

// Whether Grbl's reader refuses the line for its words: letters, numbers, groups, repeated and
// unused words, its own limits. What depends on the state of the machine, such as a feed that is
// not set or an arc that does not close, is refused with the same numbers by our own interpreter.
//
//   line  as the program has it
StockGrblRefusal stock_grbl_refusal(std::string_view line);

}  // namespace cusp::dialect
