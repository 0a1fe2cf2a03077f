// What an operation's values have to be together, beyond the range of each.
#pragma once

#include "host_tools/import/job.hpp"
#include "host_tools/import/job_table.hpp"

namespace cusp::host {

// Throws InputError where the strategy misses a value, where values contradict each other or would
// be passed over, and where an island lies outside the boundary.
//
// table  that the operation was read from: errors name its place
void check_operation(const JobTable& table, const Operation& operation);

}  // namespace cusp::host
