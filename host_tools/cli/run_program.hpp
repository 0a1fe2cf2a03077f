// What `cusp sim` does with a program: runs it until Ctrl-C at most, and writes its statistics.
#pragma once

#include <string>

#include "host_tools/simulate/simulation.hpp"

namespace cusp::cli {

// From here on SIGINT and SIGTERM end the run, not the process.
//
// stats  JSON to write; empty: none
//
// Throws InputError where a file can't be read or written.
simulate::SimulationResult run_program(const std::string& program,
                                       simulate::SimulationOptions options,
                                       const std::string& stats);

// What ended the run before its time, on the standard error stream.
void print_faults(const std::string& program, const simulate::SimulationResult& result);

}  // namespace cusp::cli
