// Reads the file of a material.
//
//     const job::Material material = read_material("aluminium", folder_of_the_job);
#pragma once

#include <filesystem>
#include <string>

#include "host_tools/job/job/material.hpp"

namespace cusp::import {

// name    of a material that comes with the program, or a path that ends in .toml
// folder  that the path is relative to
//
// Errors: InputError with file, line and key, or with the names that there are.
job::Material read_material(const std::string& name, const std::filesystem::path& folder);

}  // namespace cusp::import
