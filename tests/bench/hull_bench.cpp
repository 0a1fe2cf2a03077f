// Time of a layered roughing plan against the number of patches. Good: time over patches stays
// within a factor of 3 from 10 to 10000 patches of one size.
#include <benchmark/benchmark.h>
#include <cmath>
#include <sys/resource.h>

#include "host_tools/hull_rough/hull_rough.hpp"
#include "tests/support/tap.hpp"

namespace {

using namespace cusp::host;

// Hills of one size over a square of `patches` patches of 10 x 10 mm.
Surface hills(int patches)
{
    const int side = static_cast<int>(std::lround(std::sqrt(patches))) + 3;
    std::vector<cusp::Vec3d> net;
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            net.push_back({10.0 * i, 10.0 * j, 8 * std::sin(i * 0.7) * std::cos(j * 0.6)});
        }
    }
    return bicubic(side, side, std::move(net));
}

void rough(benchmark::State& state)
{
    Job job;
    job.file = "bench";
    job.feed = 1000;
    job.plunge_feed = 200;
    job.clearance = 5;
    Operation operation;
    operation.floor = {hills(static_cast<int>(state.range(0)))};
    operation.tool = {1, ToolShape::kFlat, 4, 0};
    operation.plan_tolerance = 0.02;
    operation.max_depth = 2;
    operation.min_depth = 1;
    operation.extra_subdivision = static_cast<int>(state.range(1));
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
