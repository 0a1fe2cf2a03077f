// Which keys of an operation belong to which strategies.
#pragma once

#include <string>

#include "host_tools/import/job_table.hpp"

namespace cusp::import {

// Throws InputError where the operation has a key that its strategy does not know.
void refuse_keys_of_others(const toml::table& entry,
                           const JobTable& table,
                           const std::string& strategy);

}  // namespace cusp::import
