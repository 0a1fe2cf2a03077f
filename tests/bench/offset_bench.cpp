// Offsets of pockets: the replica of Suh & Lee to completion (at most 1 ms asked for), its plan end
// to end (at most 50 ms), and how the cost of one offset grows with the number of curves.
#include <benchmark/benchmark.h>
#include <cmath>

#include "host_tools/cam/contour_pocket/contour_pocket.hpp"
#include "host_tools/geometry/offset/contour_fit.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/job/import/import.hpp"
#include "tests/papers/suh_lee/tiller_hanson.hpp"

namespace cusp::test {

using namespace contour_pocket;
using namespace import;
using namespace job;
using namespace nurbs;
using namespace offset;
using namespace toolpath;

namespace {

std::string part(const char* name)
{
    return std::string{CUSP_SOURCE_DIR "/examples/parts/suh-lee-"} + name + ".json";
}

Region2d replica()
{
    Region2d region;
    region.contours.push_back(fit_contour(read_loop(part("boundary")), 2e-3));
    region.contours.push_back(reversed(fit_contour(read_loop(part("island")), 2e-3)));
    return region;
}

void offset_replica_to_completion(benchmark::State& state)
{
    const Region2d source = replica();
    std::size_t loops = 0;
    for (auto _ : state) {
        const RegionOffset offset{source};
        loops = 0;
        for (double distance = 6.0;; distance += 4.308) {
            const Region2d level = offset.at(distance);
            if (level.contours.empty()) {
                break;
            }
            loops += level.contours.size();
        }
    }
    state.counters["loops"] = static_cast<double>(loops);
    state.counters["edges"] =
        static_cast<double>(source.contours[0].size() + source.contours[1].size());
}
BENCHMARK(offset_replica_to_completion)->Unit(benchmark::kMicrosecond);

// A gear-like contour of n curves, lines and arcs in turn.
Contour gear(int n)
{
    Contour contour;
    const auto corner = [&](int i) {
        const double angle = 6.283185307179586 * i / n;
        const double radius = 100.0 + (i % 4 < 2 ? 0.0 : 150.0 / n);
        return Vec2d{radius * std::cos(angle), radius * std::sin(angle)};
    };
    for (int i = 0; i < n; ++i) {
        const Vec2d a = corner(i);
        const Vec2d b = corner((i + 1) % n);
        const Vec2d chord = b - a;
        contour.push_back(i % 2 == 0 ? line_edge(a, b)
                                     : arc_edge(a, b, (a + b) * 0.5 + left_normal(chord), 1));
    }
    return contour;
}

void offset_by_number_of_curves(benchmark::State& state)
{
    const RegionOffset offset{{{gear(static_cast<int>(state.range(0)))}}};
    // Half the length of a curve, so that each meets its neighbours only.
    const double distance = 314.0 / static_cast<double>(state.range(0));
    for (auto _ : state) {
        benchmark::DoNotOptimize(offset.at(distance));
    }
    state.SetComplexityN(state.range(0));
}
BENCHMARK(offset_by_number_of_curves)
    ->RangeMultiplier(10)
    ->Range(10, 10000)
    ->Unit(benchmark::kMicrosecond)
    ->Complexity();

// A rational cubic wave, offset by 4 mm within 0.001 mm: Tiller and Hanson's way (decision 0005)
// and as biarcs, which are offset without further error.
Curve wave()
{
    Curve curve;
    curve.degree = 3;
    curve.knots = {0.0, 0.0, 0.0, 0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.0, 1.0, 1.0};
    for (int i = 0; i < 8; ++i) {
        curve.points.push_back({15.0 * i, i % 3 == 0 ? 4.0 : -3.0, 0.0});
        curve.weights.push_back(i % 2 == 0 ? 1.0 : 1.3);
    }
    return curve;
}

void offset_curve_by_tiller_hanson(benchmark::State& state)
{
    const Curve source = wave();
    std::size_t points = 0;
    for (auto _ : state) {
        points = tiller_hanson(source, 4.0, 1e-3).curve.points.size();
    }
    state.counters["points"] = static_cast<double>(points);
}
BENCHMARK(offset_curve_by_tiller_hanson)->Unit(benchmark::kMicrosecond);

void offset_curve_by_biarcs(benchmark::State& state)
{
    const Curve source = wave();
    std::size_t arcs = 0;
    for (auto _ : state) {
        arcs = fit_edges(source, 1e-3).size();
    }
    state.counters["arcs"] = static_cast<double>(arcs);
}
BENCHMARK(offset_curve_by_biarcs)->Unit(benchmark::kMicrosecond);

// A wavy bicubic floor under the replica, of spans x spans patches.
Surface wavy_floor(int spans)
{
    Surface floor;
    floor.degree_u = floor.degree_v = 3;
    floor.size_u = floor.size_v = spans + 3;
    for (int i = -3; i <= spans + 3; ++i) {
        floor.knots_u.push_back(std::clamp(i, 0, spans));
    }
    floor.knots_v = floor.knots_u;
    std::vector<double> places;  // of the control points, as the knots' averages
    for (std::size_t i = 0; i + 4 < floor.knots_u.size(); ++i) {
        const double middle =
            (floor.knots_u[i + 1] + floor.knots_u[i + 2] + floor.knots_u[i + 3]) / 3.0;
        places.push_back(-10.0 + 220.0 * middle / spans);
    }
    for (const double x : places) {
        for (const double y : places) {
            floor.points.push_back({x, y, -22.0 + 4.0 * std::sin(x / 30.0) * std::cos(y / 25.0)});
        }
    }
    floor.weights.assign(floor.points.size(), 1.0);
    return floor;
}

Operation replica_over(std::vector<Surface> floor)
{
    Operation operation;
    operation.strategy = &cusp::contour_pocket::kContourPocket;
    operation.part.floor = std::move(floor);
    operation.outline.boundary = read_loop(part("boundary"));
    operation.outline.islands = {read_loop(part("island"))};
    operation.tool = {1, ToolShape::kBall, 6.0, 6.0};
    operation.tolerance.scallop = 0.4;
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    return operation;
}

void plan(benchmark::State& state, const Operation& operation)
{
    Job job;
    job.file = "pocket.toml";
    job.clearance = 5.0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(plan_contour_pocket(job, operation));
    }
}

void plan_replica(benchmark::State& state)
{
    plan(state, replica_over(read_surfaces(part("floor"))));
}
BENCHMARK(plan_replica)->Unit(benchmark::kMillisecond);

// Roughing in layers and the finish; most of the time goes into tracking the stock's height.
void plan_in_layers(benchmark::State& state, ToolShape shape)
{
    Operation operation = replica_over(read_surfaces(part("floor")));
    operation.tool = {1, shape, 6.0, shape == ToolShape::kBall ? 6.0 : 0.0};
    operation.levels.max_depth = 5.0;
    operation.passes.allowance = 0.5;
    plan(state, operation);
}
BENCHMARK_CAPTURE(plan_in_layers, ball, ToolShape::kBall)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan_in_layers, flat, ToolShape::kFlat)->Unit(benchmark::kMillisecond);

void plan_by_spans_of_the_floor(benchmark::State& state)
{
    plan(state, replica_over({wavy_floor(static_cast<int>(state.range(0)))}));
}
BENCHMARK(plan_by_spans_of_the_floor)->Arg(1)->Arg(10)->Arg(100)->Unit(benchmark::kMillisecond);

// A pocket of 200 mm with a level floor, bounded by n lines, planned end to end.
void plan_by_number_of_curves(benchmark::State& state)
{
    Operation operation;
    operation.strategy = &cusp::contour_pocket::kContourPocket;
    Surface floor;
    floor.degree_u = floor.degree_v = 1;
    floor.size_u = floor.size_v = 2;
    floor.knots_u = floor.knots_v = {0.0, 0.0, 1.0, 1.0};
    floor.points = {
        {-120.0, -120.0, -8.0}, {-120.0, 120.0, -8.0}, {120.0, -120.0, -8.0}, {120.0, 120.0, -8.0}};
    floor.weights = {1.0, 1.0, 1.0, 1.0};
    operation.part.floor = {floor};
    Loop loop;
    for (const Edge& edge : gear(static_cast<int>(state.range(0)))) {
        loop.push_back({1,
                        {0.0, 0.0, 1.0, 1.0},
                        {{edge.start.x, edge.start.y, 0.0}, {edge.end.x, edge.end.y, 0.0}},
                        {1.0, 1.0}});
    }
    operation.outline.boundary = loop;
    operation.tool = {1, ToolShape::kBall, 6.0, 6.0};
    operation.tolerance.scallop = 0.4;
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    plan(state, operation);
    state.SetComplexityN(state.range(0));
}
BENCHMARK(plan_by_number_of_curves)
    ->RangeMultiplier(10)
    ->Range(10, 10000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

}  // namespace
}  // namespace cusp::test
