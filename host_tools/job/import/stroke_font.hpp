// The font of cusp: letters of single lines and arcs, for engraving. 95 characters of ASCII, those of German, and
// a few signs.
#pragma once

#include <string>

#include "host_tools/job/import/font_line.hpp"

namespace cusp::import {

FontSize stroke_font_size();

// Errors: InputError with the character that the font does not have.
FontLine stroke_line(const std::string& text, const std::string& place);

// The strokes of a character as path data of SVG, y upwards, with their width. Capitals are 6 high, small letters 4.
struct StrokeLetter {
    char32_t character;
    double width;
    const char* strokes;
};

// Nothing where the font does not have it.
const StrokeLetter* find_stroke_letter(char32_t character);

}  // namespace cusp::import
