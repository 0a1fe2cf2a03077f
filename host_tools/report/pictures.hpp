// Pictures (SVG) of what a program does and leaves, seen from above.
#pragma once

#include <string>

#include "host_tools/job/job.hpp"
#include "host_tools/verify/verify.hpp"

namespace cusp::report {

// The path over the walls of the part: cuts coloured by height, rapid moves dashed.
std::string path_picture(const job::Job& job, const verify::Program& program);

// What is left over the floor: a map of colours with its scale; black where nothing was cut.
std::string left_picture(const job::Job& job, const verify::Verification& result);

}  // namespace cusp::report
