// The options of `cusp plan` that replace a job file.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/one_line_job.hpp"

#include "CLI/App.hpp"

namespace cusp::cli {

// The arguments of `cusp plan`: a job file, or parts and options.
struct PlanCall {
    std::vector<std::string> files;  // a job file or parts
    bool print_job{false};
    std::string units{"mm"};
    bool no_roughing{false};
    import::OneLineRequest request;

    bool is_one_line() const { return !request.parts.empty(); }
    // "one-line job of part.step", or the job file.
    std::string job_name() const;
};

void add_one_line_options(CLI::App& command, PlanCall& call);

// Distinguishes parts from a job and completes the request. Call it once, after parsing.
//
// Errors: InputError where both are given, or a job with an option for parts.
void sort_call(const CLI::App& command, PlanCall& call);

}  // namespace cusp::cli
