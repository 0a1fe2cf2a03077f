// The tables [placing] of a job.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/import/placing.hpp"

namespace cusp::import {

// top     of the job
// folder  that paths in it are relative to
//
// Errors: InputError with line and key.
std::vector<Placing> read_placings(JobTable& top, const std::filesystem::path& folder);

// The files that the operations name, even of operations that are invalid otherwise.
PlacedFiles files_of_operations(const std::vector<const toml::table*>& operations,
                                const std::filesystem::path& folder);

// The path of a file that a job names.
std::string path_in(const std::filesystem::path& folder, const std::string& name);

}  // namespace cusp::import
