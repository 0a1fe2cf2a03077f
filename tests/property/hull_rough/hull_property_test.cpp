// Random models of one to four surfaces, roughed and cut in memory: no overcut, no metal under
// rapid moves.
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "host_tools/hull_rough/hull_rough.hpp"
#include "host_tools/toolpath/gcode_writer.hpp"
#include "host_tools/verify/verify.hpp"
#include "tests/property/grid_pocket/random_pockets.hpp"
#include "tests/support/temporary_folder.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::host {
namespace {

int cases()
{
    const char* const text = std::getenv("CUSP_PROPERTY_CASES");
    return text != nullptr ? std::atoi(text) : 8;
}

Job random_model(Random& random)
{
    Job job;
    job.file = "random.toml";
    job.feed = 1200;
    job.plunge_feed = 300;
    job.spindle = 10000;
    job.clearance = 5;
    Operation operation;
    operation.strategy = "hull_rough";
    operation.tool = random_tool(random);
    for (int i = whole(random, 1, 4); i > 0; --i) {
        const double x = uniform(random, 0.0, 30.0);
        const double y = uniform(random, 0.0, 20.0);
        const Box2d box{x, y, x + uniform(random, 20.0, 40.0), y + uniform(random, 20.0, 40.0)};
        operation.floor.push_back(
            random_floor(random, box, uniform(random, -5.0, 5.0), uniform(random, 1.0, 8.0)));
    }
    operation.max_depth = uniform(random, 1.5, 4.0);
    operation.min_depth = *operation.max_depth * 0.4;
    operation.extra_subdivision = whole(random, 0, 3);
    operation.contour_clearing = whole(random, 0, 2) == 0;
    operation.allowance = whole(random, 0, 1) == 0 ? 0.0 : 0.4;
    operation.plan_tolerance = 0.02;
    operation.floor_tolerance = 0.02;
    operation.output = whole(random, 0, 1) == 0 ? OutputForm::kLines : OutputForm::kArcs;
    job.tools = {operation.tool};
    job.operations = {operation};
    return job;
}

void check_model(unsigned seed)
{
    std::printf("random model seed %u\n", seed);
    Random random{seed};
    const Job job = random_model(random);
    const auto plan = plan_hull_rough(job, job.operations.front());
    double top = job.stock_top;
    for (const Surface& surface : job.operations.front().floor) {
        for (const Vec3d& p : surface.points) {
            top = std::max(top, p.z);
        }
    }
    Job cut = job;
    cut.stock_top = top;
    const test::TemporaryFolder folder;
    const std::string file = folder.file("model.ngc");
    {
        std::ofstream out{file};
        write_program(out, {"random model", false, top + job.clearance, {}}, plan);
    }
    VerifySettings settings;
    settings.pitch = 0.3;
    const VerifyFigures figures = verify(cut, file, settings, [](double) {}).figures;
    CHECK(figures.gouge_max <= 2e-3);
    CHECK(figures.ball_gouge_max.value_or(0) <= 1e-3);
    CHECK(figures.rapid_cut_max <= 0.01);
}

}  // namespace

TEST_GROUP(HullProperty){};

TEST(HullProperty, RandomModelsAreNeverCutInto)
{
    for (int i = 0; i < cases(); ++i) {
        check_model(static_cast<unsigned>(i) + 1);
    }
}

}  // namespace cusp::host
