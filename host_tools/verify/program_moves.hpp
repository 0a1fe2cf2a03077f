// A program as the moves that the controller's own interpreter makes of it, with the tool that
// cuts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/path/move.hpp"
#include "host_tools/toolpath/toolpath_measure.hpp"

namespace cusp::verify {

struct ProgramMove {
    path::Move move;
    int tool;  // the T word before it; 0 where there was none
};

struct Program {
    std::vector<ProgramMove> moves;
    toolpath::MoveCounts counts;  // a NURBS of many pieces counts once
};

// Machine coordinates are program coordinates: offsets are those of a fresh controller, whose
// tool is at x = y = 0 and at `start_z`.
//
// Errors: InputError that names the line and the controller's error.
Program read_program(const std::string& file, double start_z);

// Points of a move, at most `spacing` mm apart, the end included and the start not; mm.
void append_points(const path::Move& move, double spacing, std::vector<Vec3d>& points);

}  // namespace cusp::verify
