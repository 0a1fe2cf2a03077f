// One line of text in the units of its font, before it has a size and a place.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/drawn_shapes.hpp"

namespace cusp::import {

struct PlacedLetter {
    std::vector<DrawingPath> paths;  // x from the letter's own left, y from the baseline
    double x{};                      // of its left, from the line's beginning
    double width{};                  // to the next letter
};

struct FontLine {
    std::vector<PlacedLetter> letters;
    double width{};
};

struct FontSize {
    double capital;  // height of H
    double line;     // from one baseline to the next
};

// The characters of a text in UTF-8. Precondition: it is well formed; what is not counts as U+FFFD.
std::vector<char32_t> characters_of(const std::string& text);

// "é (U+00E9)" of the character.
std::string name_of_character(char32_t character);

}  // namespace cusp::import
