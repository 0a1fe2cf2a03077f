// The tables of a job file, of a library of tools and of a post, key by key.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::import {

// The file itself: its keys, and those of its tables as members. `operation` is none of these
// members: its keys are those of its strategy.
const job::KeyTable& job_table();
const job::KeyTable& library_table();
const job::KeyTable& machine_table();
const job::KeyTable& material_table();
const job::KeyTable& tool_table();
const job::KeyTable& cutting_table();
const job::KeyTable& stock_table();
const job::KeyTable& placing_table();
const job::KeyTable& fixture_table();
const job::KeyTable& setup_table();
const job::KeyTable& post_table();

// The strategy that the operation names.
// Errors: InputError where it names none of them, or has a key that its strategy does not take.
const job::Strategy& strategy_of(JobTable& operation, const job::Strategies& strategies);

}  // namespace cusp::import
