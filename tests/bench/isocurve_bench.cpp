// Planning of sine-hills with the proof of every move, and one certified distance. A good number:
// under a second for the plan, about a microsecond for a distance.
#include <string>

#include "benchmark/benchmark.h"

#include "host_tools/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/surface_offset/surface_model.hpp"

using namespace cusp;
using namespace cusp::host;

namespace {

std::vector<Surface> sine_hills()
{
    return read_surfaces(std::string{CUSP_SOURCE_DIR} + "/tests/parts/sine-hills.json");
}

void plan_sine_hills(benchmark::State& state)
{
    Job job;
    job.file = "bench";
    job.tools = {{1, ToolShape::kBall, 3, 3}};
    job.feed = 1000;
    job.plunge_feed = 250;
    job.stock_top = 8.5;
    job.clearance = 5;
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

}  // namespace
