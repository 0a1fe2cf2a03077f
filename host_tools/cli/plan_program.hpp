// Plans the operations of a job and writes program and statistics, for `cusp plan`.
#pragma once

#include <cstdio>
#include <string>

#include "host_tools/cli/plan_statistics.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::cli {

struct PlanOutput {
    std::string program;      // G-code to write
    std::string stats;        // JSON to write; empty: none
    double blend{};           // in the job's units: G64 P; 0: the exact path
    std::FILE* said{stdout};  // receives one line for each operation
};

// Sets only `progress` of the job and, for the rounding of its post, tolerances; the job is not copied
// since meshes may be large.
//
// title  the origin of the program, for its first comment
//
// Throws InputError where an operation can't be planned, there is nothing to cut, or a file can't
// be written.
Plan plan_program(job::Job& job, const std::string& title, const PlanOutput& output);

}  // namespace cusp::cli
