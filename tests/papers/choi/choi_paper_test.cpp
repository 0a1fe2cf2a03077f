// Choi, Cho & Kim: what the paper prints of its pockets, from the jobs in examples/grid_pocket.
#include <map>
#include <memory>
#include <string>
#include <variant>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/grid_pocket/grid_pocket.hpp"
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/job/job/job.hpp"
#include "tests/support/test_jobs.hpp"

using namespace cusp::grid_pocket;
using namespace cusp::import;
using namespace cusp::job;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

constexpr double kOneInch = 25.4;

Job job_of(const std::string& name)
{
    Job job = read_job(CUSP_SOURCE_DIR "/examples/grid_pocket/" + name + ".toml",
                       cusp::strategies::all());
    // The main path by itself, as the paper counts it.
    Operation& operation = job.operations.front();
    operation.levels.max_depth.reset();
    cusp::grid_pocket::grid_keys(operation).zigzag.clear();
    return job;
}

PlannedOperation rectangle(double arc_tolerance_inch, ToleranceSide side)
{
    Job job = job_of("rectangle");
    cusp::grid_pocket::grid_keys(job.operations.front()).arc_tolerance =
        arc_tolerance_inch * kOneInch;
    job.operations.front().tolerance.side = side;
    return plan_grid_pocket(job, job.operations.front()).front();
}

}  // namespace

TEST_GROUP(ChoiPaper){};

TEST(ChoiPaper, RectangleTakesAtMost125CommandsAtOneHundredthByThePapersRule)
{
    const PlannedOperation plan = rectangle(.01, ToleranceSide::kBoth);
    DOUBLES_EQUAL(2016, count_of(plan, "cells"), 0);
    CHECK(count_of(plan, "main_path_moves") <= 125);
    CHECK(plan.stats.gouge_bound_mm <= .01 * kOneInch + 1e-6);
}

TEST(ChoiPaper, RectangleTakesAtMost225CommandsAtOneThousandthByThePapersRule)
{
    CHECK(count_of(rectangle(.001, ToleranceSide::kBoth), "main_path_moves") <= 225);
}

TEST(ChoiPaper, RectangleIsNeverCutIntoWhereTheToleranceIsOutside)
{
    const PlannedOperation plan = rectangle(.001, ToleranceSide::kOutside);
    CHECK(plan.stats.gouge_bound_mm <= 1e-6);
    CHECK(count_of(plan, "main_path_moves") <= 300);
}

TEST(ChoiPaper, RectangleStaysUnderThePapersRoughness)
{
    CHECK(count_of(rectangle(.01, ToleranceSide::kOutside), "roughness_mm") <= .0089 * kOneInch);
}

TEST(ChoiPaper, PolygonWastesAtMostOnePercentOfItsSteps)
{
    const Job job = job_of("polygon");
    const PlannedOperation plan = plan_grid_pocket(job, job.operations.front()).front();
    DOUBLES_EQUAL(712, count_of(plan, "cells"), 0);
    CHECK(count_of(plan, "backtracks") <= .01 * count_of(plan, "steps"));
    CHECK(plan.stats.gouge_bound_mm <= 1e-6);
    CHECK(count_of(plan, "roughness_mm") <= .04 * kOneInch);
}
