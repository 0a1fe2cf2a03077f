// Random models of one to nine surfaces, roughed by one to three tools and cut in memory: no
// overcut, no stock under rapid moves, no layer left uncleared, no cut deeper than reported.
#include <cstdio>
#include <fstream>

#include "host_tools/cam/hull_rough/hull_patch.hpp"
#include "host_tools/cam/hull_rough/hull_rough.hpp"
#include "host_tools/geometry/toolpath/gcode_writer.hpp"
#include "host_tools/judge/verify/verify.hpp"
#include "tests/generators/random_jobs.hpp"
#include "tests/support/plates.hpp"
#include "tests/support/property_cases.hpp"
#include "tests/support/temporary_folder.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

#include "tests/support/leaks_on_threads.hpp"
#include "tests/support/test_jobs.hpp"

namespace cusp::test {

using namespace hull_rough;
using namespace job;
using namespace nurbs;
using namespace offset;
using namespace toolpath;
using namespace verify;

namespace {

// Sheets at random positions; steps that share edges, flat or nearly flat; small islands over a floor.
std::vector<Surface> random_surfaces(Random& random)
{
    std::vector<Surface> out;
    switch (whole(random, 0, 2)) {
        case 0:
            for (int i = whole(random, 1, 4); i > 0; --i) {
                const Box2d box = random_box(random, {30, 20}, 20, 40);
                const double rough = uniform(random, 1.0, 8.0);
                const double middle = uniform(random, -5.0, 5.0);
                out.push_back(random_floor(random, box, middle, rough));
            }
            return out;
        case 1:
            for (int i = 0; i < 9; ++i) {
                const double x = 10.0 * (i / 3);
                const double y = 10.0 * (i % 3);
                const double rough = 0.5 * whole(random, 0, 2);
                const double middle = -2.5 * whole(random, 0, 3);
                out.push_back(random_floor(random, {x, y, x + 10, y + 10}, middle, rough));
            }
            return out;
        default:
            out.push_back(random_floor(random, {0, 0, 50, 40}, -8, 0.5));
            for (int i = whole(random, 1, 5); i > 0; --i) {
                const Box2d box = random_box(random, {42, 32}, 2, 10);
                const double rough = uniform(random, 0.5, 4.0);
                const double middle = uniform(random, -6.0, 3.0);
                out.push_back(random_floor(random, box, middle, rough));
            }
            return out;
    }
}

// Top of the stock: of the hull box, or of the job where that is higher.
double stock_top(const Job& job)
{
    double top = job.stock_top;
    std::vector<Surface> whole_surfaces = job.operations.front().part.floor;
    for (Surface& surface : whole_surfaces) {
        surface.trims.clear();
    }
    for (const HullPatch& patch : hull_patches(whole_surfaces)) {
        top = std::max(top, patch.top);
    }
    return top;
}

// One to three cutters of any shapes, in any order.
std::vector<Tool> random_tools(Random& random)
{
    std::vector<Tool> out;
    for (int i = whole(random, 1, 3); i > 0; --i) {
        Tool tool = random_tool(random);
        if (whole(random, 0, 2) == 0) {
            tool.shape = ToolShape::kBull;
            tool.corner_radius = tool.radius * uniform(random, 0.2, 0.8);
        }
        tool.number = i;
        out.push_back(tool);
    }
    return out;
}

Job random_model(Random& random)
{
    Operation operation;
    operation.strategy = &cusp::hull_rough::kHullRough;
    operation.part.floor = random_surfaces(random);
    for (Surface& surface : operation.part.floor) {
        if (whole(random, 0, 3) == 0) {
            trim(random, surface);
        }
    }
    operation.tools = random_tools(random);
    operation.tool = operation.tools.front();
    operation.levels.max_depth = uniform(random, 1.5, 4.0);
    operation.levels.min_depth = *operation.levels.max_depth * 0.4;
    cusp::hull_rough::hull_keys(operation).extra_subdivision = whole(random, 0, 3);
    cusp::hull_rough::hull_keys(operation).contour_clearing = whole(random, 0, 1) == 0;
    operation.passes.allowance = whole(random, 0, 1) == 0 ? 0.0 : 0.4;
    operation.tolerance.plan = 0.02;
    operation.tolerance.floor = 0.02;
    operation.output = whole(random, 0, 1) == 0 ? OutputForm::kLines : OutputForm::kArcs;
    cusp::hull_rough::hull_keys(operation).overlap = whole(random, 0, 2) == 0 ? 0.3 : 0.0;
    operation.passes.traversal = whole(random, 0, 3) == 0 ? Traversal::kOneWay : Traversal::kZigzag;
    constexpr EntryKind kEntries[]{EntryKind::kAuto, EntryKind::kHelix, EntryKind::kRamp,
                                   EntryKind::kPlunge};
    operation.passes.entry = kEntries[whole(random, 0, 3)];
    Job job = job_of(operation);
    // A slower feed makes more changes of cutter worthwhile.
    job.feed = whole(random, 0, 1) == 0 ? 1200 : 100;
    job.stock_top = whole(random, 0, 2) == 0 ? stock_top(job) + uniform(random, 0.0, 4.0) : 0.0;
    return job;
}

VerifyFigures cut_in_memory(const Job& job, const std::vector<PlannedOperation>& plan)
{
    Job raised = job;
    raised.stock_top = stock_top(job);
    const test::TemporaryFolder folder;
    const std::string file = folder.file("model.ngc");
    {
        std::ofstream out{file};
        write_program(out, {"random model", false, raised.stock_top + job.clearance, {}}, plan);
    }
    VerifySettings settings;
    settings.pitch = 0.3;
    return verify::verify(raised, file, settings, [](double) {}).figures;
}

void check_model(unsigned seed)
{
    std::printf("random model seed %u\n", seed);
    Random random{seed};
    const Job job = random_model(random);
    const auto plan = plan_hull_rough(job, job.operations.front());
    const VerifyFigures figures = cut_in_memory(job, plan);
    CHECK(figures.gouge_max <= 2e-3);
    CHECK(figures.ball_gouge_max.value_or(0) <= 1e-3);
    CHECK(figures.rapid_cut_max <= 0.01);
    DOUBLES_EQUAL(0, count_of(plan.front(), "left_mm2"), 0);
    CHECK(figures.cut_depth_max <= count_of(plan.front(), "deepest_cut_mm") + 0.01);
    CHECK(count_of(plan.front(), "deepest_cut_mm") <=
          1.1 * *job.operations.front().levels.max_depth + 1e-5);
}

// Two halls with a neck between them where only a small cutter fits, and a shallow slit beside
// them: small cutter above, large one below.
std::vector<Surface> halls_and_slit()
{
    return {plate(0, 0, 10, 110, 0),    plate(10, 0, 100, 10, 0),    plate(10, 100, 100, 110, 0),
            plate(100, 0, 105, 110, 0), plate(110, 0, 115, 110, 0),  plate(54, 10, 56, 52, 0),
            plate(54, 58, 56, 100, 0),  plate(105, 0, 110, 110, -4), plate(10, 10, 54, 100, -12),
            plate(54, 52, 56, 58, -12), plate(56, 10, 100, 100, -12)};
}

}  // namespace

TEST_GROUP(HullProperty){};

TEST(HullProperty, ALargeFlatCutterMeetsWhatASmallBallLeftAtTheFootOfWalls)
{
    Operation operation;
    operation.strategy = &cusp::hull_rough::kHullRough;
    operation.part.floor = halls_and_slit();
    operation.tools = {{1, ToolShape::kFlat, 5, 0}, {2, ToolShape::kBall, 2, 2}};
    operation.tool = operation.tools.front();
    operation.levels.max_depth = 2;
    operation.levels.min_depth = 1;
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    Job job = job_of(operation);
    job.feed = 100;
    const auto plan = plan_hull_rough(job, operation);
    LONGS_EQUAL(2, plan.size());
    LONGS_EQUAL(2, plan.front().path.tool.number);
    LONGS_EQUAL(1, plan.back().path.tool.number);
    const VerifyFigures figures = cut_in_memory(job, plan);
    CHECK(figures.gouge_max <= 1e-3);
    CHECK(figures.rapid_cut_max <= 0.01);
    CHECK(figures.cut_depth_max <= count_of(plan.front(), "deepest_cut_mm") + 0.01);
}

TEST(HullProperty, RandomModelsAreNeverCutInto)
{
    for (int i = 0; i < property_cases(8); ++i) {
        check_model(static_cast<unsigned>(i) + 1);
    }
}

}  // namespace cusp::test
