// Planning of sine-hills with the proof of every move, and one certified distance; roughing and the
// approximated offset against the number of patches. Good: under a second for the plan, about a
// microsecond for a distance; time over patches within a factor of 3 from 100 patches on.
#include <string>

#include "benchmark/benchmark.h"

#include "host_tools/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/adaptive_isocurve/rough_levels.hpp"
#include "host_tools/surface_offset/offset_surface.hpp"
#include "host_tools/surface_offset/surface_model.hpp"
#include "tests/support/test_jobs.hpp"

using namespace cusp;
using namespace cusp::host;

namespace {

std::vector<Surface> sine_hills()
{
    return read_surfaces(std::string{CUSP_SOURCE_DIR} + "/tests/parts/sine-hills.json");
}

void plan_sine_hills(benchmark::State& state)
{
    Job job = plain_job();
    job.tools = {{1, ToolShape::kBall, 3, 3}};
    job.stock_top = 8.5;
    Operation operation;
    operation.strategy = "adaptive_isocurve";
    operation.floor = sine_hills();
    operation.tool = job.tools.front();
    operation.plan_tolerance = operation.floor_tolerance = 0.005;
    operation.scallop = 0.02;
    for (auto _ : state) {
        const auto planned = plan_adaptive_isocurve(job, operation);
        state.counters["points"] = planned.front().stats.cl_points;
        state.counters["gouge_bound_mm"] = planned.front().stats.gouge_bound_mm;
    }
}
BENCHMARK(plan_sine_hills)->Unit(benchmark::kMillisecond);

void certified_distance(benchmark::State& state)
{
    const SurfaceModel model{sine_hills()};
    const Tool ball{1, ToolShape::kBall, 3, 3};
    double u = 1;
    for (auto _ : state) {
        u = u > 98 ? 1 : u + 0.3;
        const SurfacePoint p = model.evaluate(0, u, 50);
        const Vec3d tip = p.point + upward_normal(p) * 3.002 - Vec3d{0, 0, 3};
        benchmark::DoNotOptimize(model.clearance(ball, tip, 0.1).distance);
    }
}
BENCHMARK(certified_distance);

void count_patches(benchmark::State& state)
{
    state.counters["us_per_patch"] = benchmark::Counter(
        static_cast<double>(state.range(0)) * 1e-6,
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void offset_within_two_micrometres(benchmark::State& state)
{
    const Surface surface = hills(static_cast<double>(state.range(0)));
    for (auto _ : state) {
        const OffsetSurface offset{surface, {3.0, 0.0018}};
        state.counters["bound_mm"] = offset.error_bound();
        state.counters["control_points"] = offset.control_points();
    }
    count_patches(state);
}
BENCHMARK(offset_within_two_micrometres)
    ->RangeMultiplier(10)
    ->Range(10, 1000)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

// range(1): of one cutter, or of a smaller one after it, too.
void rough_levels(benchmark::State& state)
{
    Job job = plain_job();
    job.stock_top = 9;
    Operation operation;
    operation.strategy = "adaptive_isocurve";
    operation.roughing = true;
    operation.floor = {hills(static_cast<double>(state.range(0)))};
    operation.tools = {{1, ToolShape::kFlat, 4, 0}};
    if (state.range(1) > 1) {
        operation.tools.push_back({2, ToolShape::kBall, 2, 2});
    }
    operation.plan_tolerance = operation.floor_tolerance = 0.02;
    operation.allowance = 0.3;
    operation.max_depth = 3;
    for (auto _ : state) {
        double moves = 0;
        for (const PlannedOperation& planned : plan_rough_levels(job, operation)) {
            moves += static_cast<double>(planned.path.moves.size());
            state.counters["gouge_bound_mm"] = planned.stats.gouge_bound_mm;
        }
        state.counters["moves"] = moves;
    }
    count_patches(state);
}
BENCHMARK(rough_levels)
    ->ArgsProduct({{10, 30, 100}, {1, 2}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
