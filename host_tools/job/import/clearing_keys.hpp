// The keys of an operation about the load of its tool.
#pragma once

#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::import {

// clearing, max_engagement; with step_over in a pocket. The tool has been read.
void read_clearing(JobTable& table, const job::Strategy& strategy, job::Operation& operation);

// chip_load, feed_min, feed_max. The tools have been read.
void read_chip_load(JobTable& table, job::Operation& operation);

}  // namespace cusp::import
