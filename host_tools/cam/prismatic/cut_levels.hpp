// Shared by all 2.5-D operations: levels, the head of a path, the name in messages.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::prismatic {

// z of each level, the highest first, the bottom last: equal ones of at most max_depth, down to
// `depth` (mm) below the top.
//
// Errors: InputError where there are more than a thousand.
std::vector<double> cut_levels(const job::Job& job, const job::Operation& operation, double depth);

// Tool, feeds and a comment; no moves yet.
toolpath::PlannedOperation begun(const job::Job& job,
                                 const job::Operation& operation,
                                 const std::string& comment);

// Counts passes, levels, points and retracts.
void count_moves(const toolpath::ToolpathWriter& writer,
                 int passes,
                 int levels,
                 toolpath::PlannedOperation& planned);

// mm: chord tolerance, so small that the flank of a conical tool keeps the tolerance of heights too.
double chord_tolerance(const job::Operation& operation);

// The z at which rapid moves end above an uncut top.
inline double rapid_end(const job::Job& job, double top)
{
    return std::min(top + toolpath::kRapidClearance, job.stock_top + job.clearance);
}

// "job.toml: operation 2: profile: ".
std::string operation_text(const job::Job& job, const job::Operation& operation);

}  // namespace cusp::prismatic
