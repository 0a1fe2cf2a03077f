// The keys of a job's tables, and which keys of an operation belong to which strategies.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/job_table.hpp"

namespace cusp::import {

std::vector<std::string> strategy_names();
std::vector<std::string> job_keys();
std::vector<std::string> library_keys();
std::vector<std::string> tool_keys();
std::vector<std::string> fixture_keys();
std::vector<std::string> setup_keys();
std::vector<std::string> cutting_keys();
std::vector<std::string> stock_keys();
std::vector<std::string> placing_keys();
std::vector<std::string> tabs_keys();
std::vector<std::string> operation_keys();

// Throws InputError where the operation has a key that its strategy does not accept.
void refuse_keys_of_others(const toml::table& entry,
                           const JobTable& table,
                           const std::string& strategy);

}  // namespace cusp::import
