// Planning of sine-hills with the proof of every move, and one certified distance; roughing and the
// approximated offset against the number of patches; the lowest ball over places beside a concave
// edge; a noisy scan. Good: under a second for the plan, about a microsecond for a distance; time
// over patches within a factor of 3 from 100 patches on; two drops a place, one of them the
// guess's; under 5 s for the scan, and what is left there proved.
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "benchmark/benchmark.h"

#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/adaptive_isocurve/waterline_roughing.hpp"
#include "host_tools/geometry/drop_cutter/lowest_position_search.hpp"
#include "host_tools/geometry/part_model/offset_surface.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/job/import/import.hpp"
#include "tests/support/test_jobs.hpp"

using namespace cusp;
using namespace cusp::adaptive_isocurve;
using namespace cusp::drop_cutter;
using namespace cusp::import;
using namespace cusp::job;
using namespace cusp::nurbs;
using namespace cusp::part_model;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

std::vector<Surface> sine_hills()
{
    return read_surfaces(std::string{CUSP_SOURCE_DIR} + "/examples/parts/sine-hills.json");
}

void plan_sine_hills(benchmark::State& state)
{
    Job job = plain_job();
    job.tools = {{1, ToolShape::kBall, 3, 3}};
    job.stock_top = 8.5;
    Operation operation;
    operation.strategy = &cusp::adaptive_isocurve::kAdaptiveIsocurve;
    operation.part.floor = sine_hills();
    operation.tool = job.tools.front();
    operation.tolerance.plan = operation.tolerance.floor = 0.005;
    operation.tolerance.scallop = 0.02;
    for (auto _ : state) {
        const auto planned = plan_adaptive_isocurve(job, operation);
        state.counters["points"] = planned.front().stats.cl_points;
        state.counters["gouge_bound_mm"] = planned.front().stats.gouge_bound_mm;
    }
}
BENCHMARK(plan_sine_hills)->Unit(benchmark::kMillisecond);

// As a scanner sees level ground: corners 1 mm apart, each off it by chance.
std::vector<std::array<Vec3d, 3>> noisy_scan(int count)
{
    std::mt19937 random{1};
    std::normal_distribution<double> off{0, 0.05};
    std::vector<Vec3d> corners;
    for (int k = 0; k < (count + 1) * (count + 1); ++k) {
        corners.push_back({static_cast<double>(k / (count + 1)),
                           static_cast<double>(k % (count + 1)), off(random)});
    }
    std::vector<std::array<Vec3d, 3>> mesh;
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) {
            const Vec3d* at = &corners[static_cast<std::size_t>(i * (count + 1) + j)];
            const Vec3d* next = at + count + 1;
            mesh.push_back({at[0], next[0], next[1]});
            mesh.push_back({at[0], next[1], at[1]});
        }
    }
    return mesh;
}

// Side of the scan in mm.
void plan_noisy_scan(benchmark::State& state)
{
    Job job = plain_job();
    job.tools = {{1, ToolShape::kBall, 3, 3}};
    job.stock_top = 8.5;
    Operation operation;
    operation.strategy = &cusp::adaptive_isocurve::kAdaptiveIsocurve;
    operation.part.mesh = noisy_scan(static_cast<int>(state.range(0)));
    operation.tool = job.tools.front();
    operation.tolerance.plan = operation.tolerance.floor = 0.01;
    operation.tolerance.scallop = 0.03;
    for (auto _ : state) {
        const auto planned = plan_adaptive_isocurve(job, operation);
        state.counters["points"] = planned.front().stats.cl_points;
        state.counters["scallop_bound_mm"] = planned.front().stats.scallop_bound_mm;
    }
}
BENCHMARK(plan_noisy_scan)->Arg(25)->Arg(50)->Unit(benchmark::kMillisecond);

void certified_distance(benchmark::State& state)
{
    const PartModel model{sine_hills()};
    const Tool ball{1, ToolShape::kBall, 3, 3};
    double u = 1;
    for (auto _ : state) {
        u = u > 98 ? 1 : u + 0.3;
        const SurfacePoint p = model.evaluate(0, u, 50);
        const Vec3d tip = p.point + upward_normal(p) * 3.002 - Vec3d{0, 0, 3};
        benchmark::DoNotOptimize(model.distance(ball, tip, 0.1).distance);
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
void waterline_roughing(benchmark::State& state)
{
    Job job = plain_job();
    job.stock_top = 9;
    Operation operation;
    operation.strategy = &cusp::adaptive_isocurve::kAdaptiveIsocurve;
    operation.passes.roughing = true;
    operation.part.floor = {hills(static_cast<double>(state.range(0)))};
    operation.tools = {{1, ToolShape::kFlat, 4, 0}};
    if (state.range(1) > 1) {
        operation.tools.push_back({2, ToolShape::kBall, 2, 2});
    }
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    operation.passes.allowance = 0.3;
    operation.levels.max_depth = 3;
    for (auto _ : state) {
        double moves = 0;
        for (const PlannedOperation& planned : plan_waterline_roughing(job, operation)) {
            moves += static_cast<double>(planned.path.moves.size());
            state.counters["gouge_bound_mm"] = planned.stats.gouge_bound_mm;
        }
        state.counters["moves"] = moves;
    }
    count_patches(state);
}
BENCHMARK(waterline_roughing)
    ->ArgsProduct({{10, 30, 100}, {1, 2}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

// Along the foot of a slope that the ball can't enter, as the scallop check of a model does: for
// positions that would remove a hundredth of the radius.
void lowest_beside_a_concave_edge(benchmark::State& state)
{
    Surface wall = hills(1);
    wall.degree_u = wall.degree_v = 1;
    wall.size_u = wall.size_v = 2;
    wall.knots_u = wall.knots_v = {0, 0, 1, 1};
    wall.weights = {1, 1, 1, 1};
    Surface plate = wall;
    wall.points = {{0, 0, 0}, {0, 60, 0}, {-3, 0, 20}, {-3, 60, 20}};
    plate.points = {{0, 0, 0}, {0, 60, 0}, {30, 0, 0}, {30, 60, 0}};
    const Tool ball{1, ToolShape::kBall, 3, 3};
    const DropCutter floor{{wall, plate}, ball, 1e-4};
    double drops = 0;
    LowestPositionSearch search{ball, 0, 0.375, 3e-4, [&](double x, double y) {
                                    ++drops;
                                    return drop_tool(floor, x, y);
                                }};
    double places = 0;
    for (auto _ : state) {
        const Vec3d place{0.3 + 0.1 * std::fmod(places, 9.0), 5 + std::fmod(0.01 * places, 50.0),
                          0};
        const auto free = search.lowest_over(place, 1e9, 1e9, Vec2d{place.x + 2.5, place.y});
        benchmark::DoNotOptimize(search.lowest_over(place, free->height - 0.03));
        ++places;
    }
    state.counters["drops_per_place"] = drops / places;
}
BENCHMARK(lowest_beside_a_concave_edge)->Unit(benchmark::kMicrosecond);

}  // namespace
