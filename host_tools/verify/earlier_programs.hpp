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

// The feed moves of a program as straight moves. Tools are those that its comments describe
// (tool_comment.hpp), else those of the job with the same number. A program that names no tool is
// cut with the job's tool, where that has only one.
//
// Errors: InputError where the program cannot be read, or a tool of its feed moves is not known.
std::vector<EarlierCut> earlier_cuts(const job::Job& job, const std::string& file);

// The programs of [stock] program, then those of `after` of the operations, each once.
std::vector<std::string> earlier_programs(const job::Job& job);

// The tool positions of earlier_programs(), at most `spacing` mm apart.
std::vector<ToolPositions> earlier_positions(const job::Job& job, double spacing);

// Cuts the stock with earlier_programs(). Returns the volume removed, mm^3.
double cut_earlier_programs(const job::Job& job, double spacing, MachinedStock& stock);

}  // namespace cusp::verify
