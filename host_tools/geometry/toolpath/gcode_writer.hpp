// Writes planned operations as G-code: fixed point, one move a line.
#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "host_tools/geometry/toolpath/post.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::toolpath {

// The form of the whole program.
struct ProgramForm {
    std::string title;     // of the header comment
    bool inch{false};      // G20 or G21
    double clearance_z{};  // mm: the height of rapid moves, at the start and the end
    std::optional<double> blend_tolerance;  // mm: G64 P; without it G61, the exact path
    Post post{};
    int work_offset{54};  // 54 to 59: G54 to G59
};

// Positions are rounded to the post's decimals, 0.0001 mm or 0.00001 inch by default, each by
// itself, so errors do not add up. The centre of an arc is chosen after its ends are rounded: its
// radii differ by at most 0.0005 mm by default. Arcs and moves too small for the rounding become
// lines or vanish. With fewer decimals, and where a radius is written for the centre, arcs that would
// leave the planned one by more than 1.5 of the last decimal are halved.
//
// The form of the program: header comment; modes; `G0 Z` alone; the operations, with changes of
// tool between them (none for one without moves); retract; end. post.hpp has the lines.
//
// Precondition: without NURBS in the post there are none in the operations.
//
// Returns where each operation begins, in bytes from the program's first.
std::vector<std::size_t> write_program(std::ostream& out,
                                       const ProgramForm& form,
                                       const std::vector<PlannedOperation>& operations);

}  // namespace cusp::toolpath
