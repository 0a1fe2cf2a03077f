// Programs that were cut before a job's own, from any source.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/job.hpp"
#include "host_tools/verify/machined_stock.hpp"
#include "host_tools/verify/program_moves.hpp"
#include "host_tools/verify/tool_positions.hpp"

namespace cusp::verify {

// A straight feed move of a known tool.
struct EarlierCut {
    toolpath::Tool tool;
    bool is_chord;  // of an arc or a curve, which it leaves by at most 0.0002 mm
    Vec3d from;
    Vec3d to;
};

// The feed moves of a program, as straight ones. Tools are those that its comments describe
// (tool_comment.hpp), else those of the job with the same number. A program that names no tool is
// cut with the job's, where that has one only.
//
// Errors: InputError where the program cannot be read, or a tool of its feed moves is not known.
std::vector<EarlierCut> earlier_cuts(const job::Job& job, const std::string& file);

// Those of the job's stock, then those that its operations come after, each once.
std::vector<std::string> earlier_programs(const job::Job& job);

// The tool positions of earlier_programs(), at most `spacing` mm apart.
std::vector<ToolPositions> earlier_positions(const job::Job& job, double spacing);

// Cuts them. Returns the volume removed, mm^3.
double cut_earlier_programs(const job::Job& job, double spacing, MachinedStock& stock);

}  // namespace cusp::verify
