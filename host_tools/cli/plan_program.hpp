// What `cusp plan` does with a job: plans its operations and writes program and statistics.
#pragma once

#include <cstdio>
#include <string>

#include "host_tools/cli/plan_statistics.hpp"
#include "host_tools/job/job.hpp"

namespace cusp::cli {

struct PlanOutput {
    std::string program;      // G-code to write
    std::string stats;        // JSON to write; empty: none
    double blend{};           // in the job's units: G64 P; 0: the exact path
    std::FILE* said{stdout};  // gets a line an operation
};

// The job only learns whom to tell of its progress: a copy of large meshes takes much memory.
//
// title  what the program is made of, for its first comment
//
// Throws InputError where an operation can't be planned, none leaves anything to cut, or a file
// can't be written.
Plan plan_program(job::Job& job, const std::string& title, const PlanOutput& output);

}  // namespace cusp::cli
