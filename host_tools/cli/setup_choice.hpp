// Which set-up of a job a program is for, and what was cut before it.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/job/job.hpp"

namespace CLI {
class App;
}

namespace cusp::cli {

// "set-up bottom, G55, turned over about x".
std::string description_of(const job::Setup& setup);

// "part.ngc" of the set-up "bottom" is "part-bottom.ngc"; "" stays.
std::string file_of_setup(const std::string& file, const job::Setup& setup);

void add_after_option(CLI::App& command, std::vector<std::string>& after);

// The set-up whose work offset the program's moves have; the only one where the job has no table of them.
//
// setups   as import::read_setups() returns them
// after    programs that were cut before, each of a set-up of the job
//
// Errors: InputError where a program can't be read, moves with two offsets or with one that no set-up has, or
// one of `after` belongs to a later set-up.
job::Job job_of_program(std::vector<job::Job> setups,
                        const std::string& program,
                        const std::vector<std::string>& after);

}  // namespace cusp::cli
