// Programs that were cut before a job's own, from any source.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/machined_stock.hpp"
#include "host_tools/judge/verify/program_moves.hpp"
#include "host_tools/judge/verify/tool_positions.hpp"

namespace cusp::verify {

// A straight feed move of a known tool.
struct EarlierCut {
    toolpath::Tool tool;
    bool is_chord;  // of an arc or a curve, which it leaves by at most 0.0002 mm
    Vec3d from;
    Vec3d to;
    std::uint32_t line{};  // of its program
};

// Errors: InputError, always: the program names no tool before its first cut, and the job has several.
[[noreturn]] void refuse_unnamed_tool(const job::Job& job, const std::string& file);

// The feed moves of a program as straight moves, with the tool that `tool_of` has for each number.
//
// The first move is left out: the place before it is not known.
std::vector<EarlierCut> straight_cuts(
    const Program& program, const std::function<const toolpath::Tool&(int number)>& tool_of);

// The feed moves of a program as straight moves. Tools are those that its comments describe
// (tool_comment.hpp), else those of the job with the same number. A program that names no tool is
// cut with the job's tool, where that has only one.
//
// Errors: InputError where the program cannot be read, or a tool of its feed moves is not known.
std::vector<EarlierCut> earlier_cuts(const job::Job& job, const std::string& file);

// Moves of a program of another set-up, in the coordinates of this one. If the stock was turned
// over, only stock that is proved to be gone counts: a feed move that goes through the box is the
// cut of a flat end, as wide as the tool was at the box's bottom, down to open_level(). Cuts from
// below that do not go through count as stock.
std::vector<EarlierCut> earlier_cuts(const job::Job& job, const job::SetupProgram& program);

// z, below any move: the height of stock through which there is a hole. Precondition: the stock has a bottom.
double open_level(const job::Job& job);

// The programs of [stock] program, then those of `after` of the operations, each once.
std::vector<std::string> earlier_programs(const job::Job& job);

// The runs of a program's tools, in its own coordinates. Tools that cut nothing need not be known.
std::vector<ToolPositions> program_positions(const job::Job& job,
                                             const std::string& file,
                                             double spacing);

// The tool positions of earlier_programs() and of turned programs, at most `spacing` mm apart.
std::vector<ToolPositions> earlier_positions(const job::Job& job, double spacing);

// Cuts the stock with earlier_programs(). Returns the volume removed, mm^3.
double cut_earlier_programs(const job::Job& job, double spacing, MachinedStock& stock);

// Heights of the stock for a comparison with the part: kNoValue where there was none, or a hole before,
// in which nothing can be wrong any more.
std::vector<double> heights_to_judge(const job::Job& job, const MachinedStock& stock);

}  // namespace cusp::verify
