// The options of `cusp plan` that stand in for a job file.
#pragma once

#include <string>
#include <vector>

#include "host_tools/import/one_line_job.hpp"

#include "CLI/App.hpp"

namespace cusp::cli {

// What the command line of `cusp plan` names: a job file, or parts and how to cut them.
struct PlanCall {
    std::vector<std::string> files;  // a job file or parts
    bool print_job{false};
    std::string units{"mm"};
    bool no_roughing{false};
    import::OneLineRequest request;

    bool is_one_line() const { return !request.parts.empty(); }
    // Of parts: "one-line job of part.step". Of a job: its file.
    std::string job_name() const;
};

void add_one_line_options(CLI::App& command, PlanCall& call);

// Distinguishes parts from a job and fills in the request. Call it once, after parsing.
//
// Errors: InputError where both are named, or an option for parts comes with a job.
void sort_call(const CLI::App& command, PlanCall& call);

}  // namespace cusp::cli
