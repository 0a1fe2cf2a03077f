// Speed of the whole firmware on the host: simulated seconds a second, and lines a second through
// parser, planner and interpolator. A good number: over 10 simulated seconds a second in real use,
// over 5000 lines a second.
#include <string>

#include "benchmark/benchmark.h"

#include "host_tools/controller/simulate/simulate.hpp"

namespace {

void run_program(benchmark::State& state, const char* name)
{
    double simulated = 0.0;
    double lines = 0.0;
    for (auto _ : state) {
        const auto result =
            cusp::simulate::simulate(std::string{CUSP_SOURCE_DIR "/tests/programs/"} + name, {});
        simulated += result.total_s;
        lines += static_cast<double>(result.lines);
    }
    state.counters["simulated_s_per_s"] = {simulated, benchmark::Counter::kIsRate};
    state.counters["lines_per_s"] = {lines, benchmark::Counter::kIsRate};
}

}  // namespace

BENCHMARK_CAPTURE(run_program, dense_lines, "spiral.ngc")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_program, surface, "surf3d.ngc")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_program, lines_and_arcs, "rsq.ngc")->Unit(benchmark::kMillisecond);
