// The report of `cusp plan`: a summary on the terminal, statistics as JSON.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

#include "nlohmann/json.hpp"

namespace cusp::cli {

struct Plan {
    std::vector<toolpath::PlannedOperation> operations;  // not empty
    std::vector<toolpath::PathMeasure> measures;         // of each operation
    std::vector<std::string> warnings;                   // not of a single planned operation
};

// The path of each operation, in order; they live as long as the plan.
std::vector<const toolpath::Toolpath*> paths_of(const Plan& plan);

// Prints lengths and times on `said`, warnings and notes on the standard error stream.
//
// notes   of the readers of parts
// output  the file that was written
void print_summary(const Plan& plan,
                   const std::vector<std::string>& notes,
                   const std::string& output,
                   std::FILE* said);

// In mm and s: the keys of the whole program, then those of `about`, then "operations".
nlohmann::ordered_json plan_statistics(const Plan& plan, const nlohmann::ordered_json& about);

}  // namespace cusp::cli
