// The run, between its options and its result.
#include "host_tools/cli/run_program.hpp"

#include "host_tools/cli/interruption.hpp"
#include "host_tools/files/files.hpp"

#include "fmt/format.h"

namespace cusp::cli {

using files::write_text;
using simulate::SimulationError;
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
    for (const SimulationError& error : result.errors) {
        const std::string code = error.code == 0     ? ""
                                 : result.alarm != 0 ? fmt::format("ALARM:{}: ", error.code)
                                                     : fmt::format("error:{}: ", error.code);
        fmt::print(stderr, "{}:{}: {}{}\n", program, error.line, code, error.text);
    }
    if (result.stopped) {
        fmt::print(stderr, "stopped before the end\n");
    }
}

}  // namespace cusp::cli
