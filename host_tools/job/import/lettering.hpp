// Text as curves: each letter of a font, set along a line or round a circle.
//
//     const Lettering sign{"CUSP", "", 12.0, {50, 20}, 0, TextAlign::kCentre};
//     const std::vector<DrawingPath> letters = paths_of_text(sign, "job.toml: operation 1: text");
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host_tools/job/import/drawn_shapes.hpp"

namespace cusp::import {

enum class TextAlign : std::uint8_t { kLeft, kCentre, kRight };

struct Lettering {
    std::string text;       // UTF-8; a line feed begins the next line
    std::string font_file;  // TrueType or OpenType; empty: the single-line font (stroke_font.hpp)
    double size{};          // mm: height of capitals
    Vec2d at;               // mm: of the first baseline, its left end, middle or right end
    double angle{};         // of the baseline, degrees, counter-clockwise from x
    TextAlign align{TextAlign::kLeft};
    // mm, of a circle through `at` that the first baseline follows. Positive: its centre is below the letters, which
    // stand on its outside; negative: above them. 0: a line. Further lines have circles about the same centre.
    double arc{};
};

// The outlines of all letters in the order of the text; of the single-line font its lines. A letter on a circle is
// turned about the middle of its width, not bent.
//
// place  begins messages
// Errors: InputError: the font file can't be read or is no font; a letter that the font does not have; a line that
// goes more than once round its circle, or lies at its centre; nothing to draw.
// Accuracy: curves of the font are exact; a font file's Bezier curves stay such.
std::vector<DrawingPath> paths_of_text(const Lettering& lettering, const std::string& place);

}  // namespace cusp::import
