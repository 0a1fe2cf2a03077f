// Reads the file of a machine, and the settings of its controller that the file names.
//
//     const job::MachineTool mill = read_machine("mill.toml", folder_of_the_job);
#pragma once

#include <filesystem>
#include <string>

#include "host_tools/job/job/machine_tool.hpp"

namespace cusp::import {

// name    path of the file
// folder  that the path is relative to
//
// Settings are lines as `$$` prints them: $30, $31 (spindle), $110 to $112 (rates), $120 to $122 (accelerations),
// $130 to $132 (travel). All other lines are ignored. Keys of the file go before settings.
//
// Errors: InputError with file, line, key, value and limit.
job::MachineTool read_machine(const std::string& name, const std::filesystem::path& folder);

}  // namespace cusp::import
