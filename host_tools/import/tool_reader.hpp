// A table [tool] of a job.
#pragma once

#include <string>

#include "host_tools/import/job_table.hpp"
#include "host_tools/import/number_ranges.hpp"
#include "host_tools/job/job.hpp"

namespace cusp::import {

// Tool numbers that controllers accept.
inline constexpr Range kToolNumber{1, 255};

// file         of the job, for messages
// index        of the tool's table, from 1: the default of its number
// millimetres  of one unit of the job
//
// Errors: InputError with line and key.
toolpath::Tool read_tool(const toml::table& table,
                         const std::string& file,
                         std::size_t index,
                         double millimetres);

}  // namespace cusp::import
