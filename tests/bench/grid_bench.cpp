// Time of cells, navigation and whole plans against the number of cells. Good: time over cells
// stays within a factor of 2 from 1e3 to 1e6, and a million cells are navigated in less than 2 s.
#include <benchmark/benchmark.h>
#include <cmath>
#include <sys/resource.h>

#include "host_tools/cam/grid_pocket/grid_navigation.hpp"
#include "host_tools/cam/grid_pocket/grid_pocket.hpp"
#include "tests/support/loops.hpp"
#include "tests/support/tap.hpp"
#include "tests/support/test_jobs.hpp"

namespace {

using namespace cusp::grid_pocket;
using namespace cusp::job;
using namespace cusp::offset;
using namespace cusp::test;
using namespace cusp::toolpath;
using cusp::Vec2d;

// The polygon of Choi, Cho & Kim, in inches.
const std::vector<Vec2d> kPolygon{{0, 0},    {2.5, 0}, {3.5, .75}, {3, 1.5},   {3.5, 2.5},
                                  {2, 2.25}, {1.5, 3}, {.25, 2.5}, {.75, 1.25}};

double peak_megabytes()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

// The side of a square cell so that the polygon has about `cells` of them.
double side_for(double cells) { return std::sqrt(6.1 / cells); }

void navigation(benchmark::State& state)
{
    Region2d region;
    region.contours.emplace_back();
    for (std::size_t i = 0; i < kPolygon.size(); ++i) {
        region.contours[0].push_back(line_edge(kPolygon[i], kPolygon[(i + 1) % kPolygon.size()]));
    }
    const RegionOffset pocket{region};
    const double side = side_for(static_cast<double>(state.range(0)));
    std::size_t cells = 0;
    for (auto _ : state) {
        const CellGrid grid{pocket, side, side, .125};
        NavigationRules rules;
        rules.free = [&](Cell c) {
            return grid.inside(c);
        };
        rules.clear_step = [](Cell, Cell) {
            return true;
        };
        rules.clear_link = [](Vec2d, Vec2d) {
            return true;
        };
        benchmark::DoNotOptimize(navigate(grid, rules));
        cells = grid.count_inside();
    }
    state.counters["cells"] = static_cast<double>(cells);
    state.counters["ns_per_cell"] = benchmark::Counter(
        static_cast<double>(cells) * 1e-9,
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["peak_MB"] = peak_megabytes();
}
BENCHMARK(navigation)->RangeMultiplier(10)->Range(1000, 1000000)->Unit(benchmark::kMillisecond);

void plan(benchmark::State& state)
{
    Job job = plain_job();
    Operation operation;
    operation.part.floor = {tap()};
    operation.outline.boundary = loop_of({{2, -10}, {115, -10}, {115, 10}, {2, 10}});
    const bool flat = state.range(1) != 0;
    operation.tool = {1, flat ? ToolShape::kFlat : ToolShape::kBall, 3, flat ? 0.0 : 3.0};
    operation.tolerance.floor = 0.02;
    operation.tolerance.plan = 0.02;
    const double side = std::sqrt(107.0 * 14 / static_cast<double>(state.range(0)));
    cusp::grid_pocket::grid_keys(operation).grid_x = side;
    cusp::grid_pocket::grid_keys(operation).grid_y = side;
    job.stock_top = 20;
    for (auto _ : state) {
        benchmark::DoNotOptimize(plan_grid_pocket(job, operation));
    }
    state.counters["peak_MB"] = peak_megabytes();
}
BENCHMARK(plan)
    ->ArgNames({"cells", "flat"})
    ->ArgsProduct({{1000, 10000, 100000, 1000000}, {0, 1}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
