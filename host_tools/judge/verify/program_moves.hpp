// A program as the moves of the controller's own interpreter, each with its tool.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "firmware/path/move.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::verify {

struct ProgramMove {
    path::Move move;
    int tool;  // the last T word before it, else the last comment "(tool N ..."; 0 if none
};

// A tool as a comment describes it.
struct DescribedTool {
    toolpath::Tool tool;
    std::uint32_t line;  // of the comment
};

struct Program {
    std::vector<ProgramMove> moves;
    std::set<int> offsets;               // of its moves: 54 for G54, to 59; 60 for G59.1 to G59.3
    std::map<int, DescribedTool> tools;  // by number: tool_comment.hpp
    toolpath::MoveCounts counts;         // a NURBS of many pieces counts once
};

inline constexpr double kStartHigh = 1000;  // mm over the stock: above any program's start

// Machine coordinates are program coordinates: offsets are those of a fresh controller, with the
// tool at x = y = 0 and at `start_z`.
//
// name  of a text in job.programs, else a file
//
// Errors: InputError with the line and the controller's error, or where comments describe one tool
// in two ways.
Program read_program(const job::Job& job, const std::string& name, double start_z);

// Points of a move, mm, at most `spacing` apart; with its end, without its start.
void append_points(const path::Move& move, double spacing, std::vector<Vec3d>& points);

}  // namespace cusp::verify
