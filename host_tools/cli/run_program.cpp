// Runs with progress and writes the statistics.
#include "host_tools/cli/run_program.hpp"

#include "host_tools/base/files/files.hpp"
#include "host_tools/cli/interruption.hpp"

#include "fmt/format.h"

namespace cusp::cli {

using files::write_text;
using program_run::RunError;
using simulate::SimulationOptions;
using simulate::SimulationResult;

SimulationResult run_program(const std::string& program,
                             SimulationOptions options,
                             const std::string& stats)
{
    const std::atomic<int>& stops = count_interruptions();
    options.stop = [&stops] {
        return stops.load() > 0;
    };
    SimulationResult result = simulate::simulate(program, options);
    if (!stats.empty()) {
        write_text(stats, statistics_json(result));
    }
    return result;
}

void print_faults(const std::string& program, const SimulationResult& result)
{
    for (const RunError& error : result.errors) {
        fmt::print(stderr, "{}:{}: {}\n", program, error.line, fault_text(result, error));
    }
    if (result.stopped) {
        fmt::print(stderr, "stopped before the end\n");
    }
}

}  // namespace cusp::cli
