// Random pockets cut in memory: no gouge, no stock under rapid moves, nothing left over the
// computed roughness.
#include <cstdio>
#include <fstream>

#include "host_tools/cam/grid_pocket/grid_pocket.hpp"
#include "host_tools/geometry/toolpath/gcode_writer.hpp"
#include "host_tools/judge/verify/verify.hpp"
#include "tests/generators/random_pockets.hpp"
#include "tests/support/property_cases.hpp"
#include "tests/support/temporary_folder.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

#include "tests/support/leaks_on_threads.hpp"

namespace cusp::test {

using namespace grid_pocket;
using namespace job;
using namespace toolpath;
using namespace verify;

namespace {

VerifyFigures cut_in_memory(const Job& job, const std::vector<PlannedOperation>& plan)
{
    const test::TemporaryFolder folder;
    const std::string file = folder.file("pocket.ngc");
    {
        std::ofstream out{file};
        write_program(out, {"random pocket", false, job.stock_top + job.clearance, {}}, plan);
    }
    VerifySettings settings;
    settings.pitch = 0.27;
    settings.spacing = 0.2;
    return verify::verify(job, file, settings, [](double) {}).figures;
}

void check_pocket(const Job& job)
{
    const Operation& operation = job.operations.front();
    std::vector<PlannedOperation> plan;
    try {
        plan = plan_grid_pocket(job, operation);
    } catch (const InputError& error) {
        // The tool may not fit into a narrow shape: then the message must say so.
        CHECK_TEXT(std::string(error.what()).find("does not fit") != std::string::npos,
                   error.what());
        return;
    }
    const VerifyFigures figures = cut_in_memory(job, plan);
    const OperationStats& stats = plan.front().stats;
    std::printf("  %d passes, left %.4f of %.4f mm, deepest cut %.3f mm\n", stats.passes,
                figures.scallop_max, stats.scallop_bound_mm, figures.cut_depth_max);
    CHECK(stats.gouge_bound_mm <= 1e-6);
    CHECK(figures.gouge_max <= 2e-3);
    CHECK(figures.ball_gouge_max.value_or(0) <= 1e-3);
    CHECK(figures.wall_gouge_max.value_or(0) <= 1e-3);
    CHECK(figures.rapid_cut_max <= 0.01);
    DOUBLES_EQUAL(0, figures.uncut_share, 0);
    if (job.operations.front().levels.max_depth) {
        CHECK(figures.cut_depth_max <= *job.operations.front().levels.max_depth + 0.01);
    }
    // Resolution of the height map in memory.
    CHECK(figures.scallop_max <= stats.scallop_bound_mm + 0.01);
}

}  // namespace

TEST_GROUP(GridProperty){};

TEST(GridProperty, RandomPocketsAreCutToTheComputedRoughnessWithoutGouge)
{
    for (int i = 0; i < property_cases(8); ++i) {
        const auto seed = static_cast<unsigned>(i) + 1;
        std::printf("random pocket seed %u\n", seed);
        Random random{seed};
        check_pocket(random_pocket(random));
    }
}

TEST(GridProperty, SoAreRandomPocketsWithLayersOfBoundedEngagement)
{
    for (int i = 0; i < property_cases(4); ++i) {
        const unsigned seed = property_seed(1001) + static_cast<unsigned>(i);
        std::printf("random adaptive pocket seed %u\n", seed);
        Random random{seed};
        check_pocket(random_adaptive_pocket(random));
    }
}

// A flat end left more than was computed.
TEST(GridProperty, SeedsThatOnceFailed)
{
    Random random{110004};
    check_pocket(random_adaptive_pocket(random));
    random.seed(2378);
    check_pocket(random_pocket(random));
}

}  // namespace cusp::test
