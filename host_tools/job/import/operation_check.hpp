// Checks that the values of an operation are consistent with each other.
#pragma once

#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::import {

// Throws InputError where the strategy lacks a value, where values contradict each other or would
// have no effect, and where an island lies outside the boundary.
//
// table  the operation's table, for line and name in messages
void check_operation(const JobTable& table, const job::Operation& operation);

}  // namespace cusp::import
