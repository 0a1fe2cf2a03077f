// A table [[fixture]] of a job.
#pragma once

#include <string>

#include "host_tools/import/job_table.hpp"
#include "host_tools/job/job.hpp"

namespace cusp::import {

// file         of the job, for messages
// index        the fixture's place among the tables, from 1
// millimetres  of one unit of the job
//
// Errors: InputError with line and key.
job::Fixture read_fixture(const toml::table& table,
                          const std::string& file,
                          std::size_t index,
                          double millimetres);

}  // namespace cusp::import
