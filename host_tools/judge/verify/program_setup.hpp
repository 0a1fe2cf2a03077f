// The set-up of a job that a program is for.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/job/job.hpp"

namespace cusp::verify {

// The set-up whose work offset the program's moves have; the only one if the job has no table of them.
//
// setups   as import::read_setups() returns them
// after    programs that were cut before, each of a set-up of the job
//
// Errors: InputError if a program can't be read, moves with two offsets or with one that no set-up has, or
// one of `after` belongs to a later set-up.
job::Job job_of_program(std::vector<job::Job> setups,
                        const std::string& program,
                        const std::vector<std::string>& after);

}  // namespace cusp::verify
