// The summary that ends the demo.
#pragma once

#include <string>

#include "host_tools/cam/plan/plan.hpp"
#include "host_tools/controller/simulate/simulate.hpp"
#include "host_tools/judge/verify/verify.hpp"

namespace cusp::cli {

// Times, lengths and depths of each tool and in total, then every figure with its limit.
std::string demo_summary(const plan::PlannedProgram& plan,
                         const simulate::SimulationResult& run,
                         const verify::Verification& cut);

}  // namespace cusp::cli
