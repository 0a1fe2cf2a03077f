// The tables of keys as text, for people and for editors.
#pragma once

#include <string>

#include "host_tools/job/job/strategy.hpp"

namespace cusp::import {

// A JSON Schema (draft-07) of the job file, indented. `x-default`, `x-kind` and `x-strategies` are for
// docs/job_tables.py. It takes what the reader takes, but for conditions between the values of keys.
std::string job_schema(const job::Strategies& strategies);

// The strategies, tables and single keys of a job, a line each, at most 100 characters wide.
std::string job_help(const job::Strategies& strategies);
// The keys of one strategy or table.
// Errors: InputError where there is none of that name, with the nearest ones.
std::string job_help(const job::Strategies& strategies, const std::string& name);

}  // namespace cusp::import
