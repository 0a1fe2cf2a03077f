// Simulates the cut of a program and writes figures and pictures, for `cusp verify`.
#pragma once

#include <string>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/verify.hpp"

namespace cusp::cli {

// Files to write; empty: none.
struct VerifyOutput {
    std::string stats;                 // JSON
    std::string path_picture;          // SVG
    std::string left_picture;          // SVG
    std::string engagement_picture{};  // SVG
};

// Prints progress. Throws InputError where the program can't be read or uses a tool that the job
// lacks, or a file can't be written.
verify::Verification verify_program(const job::Job& job,
                                    const std::string& program_file,
                                    const verify::VerifySettings& settings,
                                    const VerifyOutput& output);

// One line for each figure, then the bounds that do not hold.
std::string verification_text(const verify::Verification& result);

}  // namespace cusp::cli
