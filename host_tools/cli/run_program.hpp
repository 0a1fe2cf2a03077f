// Runs a program until its end or Ctrl-C and writes its statistics, for `cusp sim`.
#pragma once

#include <string>

#include "host_tools/controller/simulate/simulate.hpp"

namespace cusp::cli {

// Installs handlers by which SIGINT and SIGTERM end the run and not the process.
//
// stats  JSON to write; empty: none
//
// Throws InputError where a file can't be read or written.
simulate::SimulationResult run_program(const std::string& program,
                                       simulate::SimulationOptions options,
                                       const std::string& stats);

// Prints, on the standard error stream, why the run ended early.
void print_faults(const std::string& program, const simulate::SimulationResult& result);

}  // namespace cusp::cli
