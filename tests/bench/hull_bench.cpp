// Time of a layered roughing plan against the number of patches. Good: time over patches stays
// within a factor of 3 from 10 to 10000 patches of one size.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "host_tools/cam/hull_rough/hull_rough.hpp"
#include "tests/support/test_jobs.hpp"

namespace {

using namespace cusp::hull_rough;
using namespace cusp::job;
using namespace cusp::test;
using namespace cusp::toolpath;

void rough(benchmark::State& state)
{
    const Job job = plain_job();
    Operation operation;
    operation.part.floor = {hills(static_cast<double>(state.range(0)))};
    operation.tool = {1, ToolShape::kFlat, 4, 0};
    operation.tolerance.plan = 0.02;
    operation.levels.max_depth = 2;
    operation.levels.min_depth = 1;
    cusp::hull_rough::hull_keys(operation).extra_subdivision = static_cast<int>(state.range(1));
    std::size_t moves = 0;
    for (auto _ : state) {
        moves = plan_hull_rough(job, operation).front().path.moves.size();
    }
    state.counters["moves"] = static_cast<double>(moves);
    state.counters["us_per_patch"] = benchmark::Counter(
        static_cast<double>(state.range(0)) * 1e-6,
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / 1024;
}
BENCHMARK(rough)
    ->ArgsProduct({{10, 100, 1000, 10000}, {0, 2}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
