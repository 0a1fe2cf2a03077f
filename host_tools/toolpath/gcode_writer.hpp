// Writes planned operations as G-code: fixed point, one move a line.
#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::toolpath {

// Of the whole program.
struct ProgramForm {
    std::string title;     // of the header comment
    bool inch{false};      // G20 or G21
    double clearance_z{};  // mm: the height of rapid moves, at the start and the end
    std::optional<double> blend_tolerance;  // mm: G64 P; without it G61, the exact path
};

// Positions are rounded to 0.0001 mm or 0.00001 inch, each by itself, so errors do not add up. The
// centre of an arc is chosen after its ends are rounded: its radii differ by at most 0.0005 mm.
// Arcs and moves too small for the rounding become lines or vanish.
//
// The form of the program: header comment; G17 G20/G21 G40 G49 G54 G80
// G90 G94; `G0 Z` alone; the operations, tools changed by M5, T, M0; retract, M5, M30.
//
// Returns where each operation begins, in bytes from the program's first.
std::vector<std::size_t> write_program(std::ostream& out,
                                       const ProgramForm& form,
                                       const std::vector<PlannedOperation>& operations);

// A number in fixed point with at most `decimals`, without trailing zeros.
std::string fixed_point(double value, int decimals);

}  // namespace cusp::toolpath
