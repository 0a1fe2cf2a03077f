// A table [[fixture]] of a job.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/import/setup_reader.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::import {

// Those that are in the set-up, or in all.
//
// top    of the job
// setup  place of the set-up among all
//
// Errors: InputError with line and key.
std::vector<job::Fixture> read_fixtures(JobTable& top,
                                        const SetupTables& setups,
                                        std::size_t setup);

// Raises the job's clearance over the highest fixture, with a note. Rapid moves go over every fixture.
void rise_over_fixtures(job::Job& job);

}  // namespace cusp::import
