// The job of a program, for commands that take both.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/job/job.hpp"

namespace CLI {
class App;
}

namespace cusp::cli {

void add_after_option(CLI::App& command, std::vector<std::string>& after);

// Reads the job and chooses the set-up that the program is for; says which.
//
// after  programs that were cut before
job::Job job_for(const std::string& job_file,
                 const std::string& program,
                 const std::vector<std::string>& after);

}  // namespace cusp::cli
