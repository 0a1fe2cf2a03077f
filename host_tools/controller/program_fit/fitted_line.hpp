// The text of one fitted move, in the units and distance mode of the program.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "firmware/base/vec.hpp"
#include "firmware/gcode/modal_state.hpp"
#include "firmware/segmenter/arc_fitter.hpp"

namespace cusp::program_fit {

// Centre offsets are written to this, mm: 4 decimals in mm, 6 in inches.
constexpr double centre_step(bool inches) { return inches ? 25.4e-6 : 1e-4; }

// Appends a length in fixed point, without trailing zeros: exact in millimetres, and in inches to
// 9 decimals (0.03 nm).
void append_length(std::string& text, std::int64_t nm, bool inches);

struct LineWords {
    std::string_view number;  // digits of the N word, or empty
    std::string_view feed;    // of the F word, or empty
    Position from;            // machine nanometres
    Position to;
    Position work_offset;
    bool inches;
    bool incremental;
    bool names_plane;
};

// Appends one line, without its line end: N, plane, G1 G2 or G3, the axes that change, offsets, F.
void append_move(std::string& text, const segmenter::FittedMove& move, const LineWords& words);

// "G17", "G18" or "G19".
std::string_view plane_word(path::Plane plane);

}  // namespace cusp::program_fit
