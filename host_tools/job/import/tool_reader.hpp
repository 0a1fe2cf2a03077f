// A table [tool] of a job, or of a library of tools.
#pragma once

#include <string>

#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::import {

struct ReadTool {
    toolpath::Tool tool;
    job::ToolFacts facts;
};

// index  of the tool's table, from 1: the default of its number
//
// Errors: InputError with line and key.
ReadTool read_tool(JobTable& keys, std::size_t index);

// The keys `feed`, `plunge_feed`, `spindle` and `coolant` of a tool, or of an operation, which
// override the tool's. A feed without a plunge feed makes that a quarter of itself.
void read_rates(JobTable& keys, toolpath::Tool& tool);

}  // namespace cusp::import
