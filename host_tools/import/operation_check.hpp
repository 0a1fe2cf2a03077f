// Checks the values of an operation against each other, beyond the range of each.
#pragma once

#include "host_tools/import/job_table.hpp"
#include "host_tools/job/job.hpp"

namespace cusp::import {

// Throws InputError where the strategy lacks a value, where values contradict each other or would
// have no effect, and where an island lies outside the boundary.
//
// table  that the operation was read from: errors name its place
void check_operation(const JobTable& table, const job::Operation& operation);

}  // namespace cusp::import
