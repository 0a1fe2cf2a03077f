// What `cusp verify` does: cuts a program in memory and writes figures and pictures of it.
#pragma once

#include <string>

#include "host_tools/import/job.hpp"
#include "host_tools/verify/verify.hpp"

namespace cusp::host {

// Files to write; empty: none.
struct VerifyOutput {
    std::string stats;         // JSON
    std::string path_picture;  // SVG
    std::string left_picture;  // SVG
};

// Shows its progress. Throws InputError where the program can't be read, names a tool that the job
// lacks, or a file can't be written.
Verification verify_program(const Job& job,
                            const std::string& program_file,
                            const VerifySettings& settings,
                            const VerifyOutput& output);

// One figure a line, then the bounds that do not hold.
std::string verification_text(const Verification& result);

}  // namespace cusp::host
