// What the tables of keys say, for people and for editors.
#pragma once

#include <string>

#include "host_tools/job/job/strategy.hpp"

namespace cusp::import {

// A JSON Schema (draft-07) of the job file, indented. `x-default`, `x-kind` and `x-strategies` are for
// docs/job_tables.py. It takes what the reader takes, but for conditions between keys.
std::string job_schema(const job::Strategies& strategies);

// The keys of the tables of a job in aligned lines, and the strategies with a line each.
std::string job_help(const job::Strategies& strategies);
// The keys of one strategy: its own first.
std::string strategy_help(const job::Strategy& strategy);

}  // namespace cusp::import
