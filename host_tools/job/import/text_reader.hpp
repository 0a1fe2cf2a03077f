// The keys `text`, `font`, `size` ... of an operation, which spell its drawing.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/import/part_files.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::import {

// Draws the text among the parts. Returns the name of that drawing; nothing without the key `text`.
//
// folder  of the job: fonts are looked for there, and by their names in the system's folders of fonts
//
// Errors: InputError: a font that is not there, and those of paths_of_text().
std::optional<std::string> read_text(JobTable& table,
                                     const std::filesystem::path& folder,
                                     const job::Operation& operation,
                                     PartFiles& parts);

}  // namespace cusp::import
