// A table of a program that was planned, run and cut.
#pragma once

#include <string>
#include <vector>

#include "host_tools/controller/simulate/simulate.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/judge/verify/verify.hpp"

namespace cusp::report {

// Times, lengths and depths of each tool and in total, then every figure with its limit.
std::string run_summary(const std::vector<toolpath::PlannedOperation>& planned,
                        const simulate::SimulationResult& run,
                        const verify::Verification& cut);

}  // namespace cusp::report
