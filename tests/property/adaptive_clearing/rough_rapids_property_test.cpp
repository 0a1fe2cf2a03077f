// Waterline roughing of bounded engagement over random floors, by a flat end: no rapid move meets what the levels
// before have left, slivers included.
#include <cstdio>

#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/adaptive_isocurve/waterline_roughing.hpp"
#include "tests/generators/random_jobs.hpp"
#include "tests/judges/stock_under_rapids.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

#include "tests/support/leaks_on_threads.hpp"

namespace cusp::test {

using namespace job;
using namespace toolpath;

namespace {

Job block_with_floor(Random& random)
{
    Operation operation;
    operation.strategy = &adaptive_isocurve::kAdaptiveIsocurve;
    operation.passes.roughing = true;
    operation.tool = {1, ToolShape::kFlat, uniform(random, 1.5, 4.0), 0.0};
    operation.tools = {operation.tool};
    const offset::Box2d box = random_box(random, {10, 10}, 20, 35);
    operation.part.floor = {random_floor(random, box, -8, uniform(random, 1.0, 6.0))};
    operation.levels.max_depth = uniform(random, 1.5, 4.0);
    operation.passes.max_engagement = uniform(random, 40.0, 100.0);
    operation.passes.allowance = 0.2;
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    Job job = job_of(operation);
    job.stock_x = {box.x0, box.x1};
    job.stock_y = {box.y0, box.y1};
    return job;
}

std::string wrong_of(unsigned seed, StockUnderRapids stock, const PlannedOperation& planned)
{
    const double deep = stock.cut(planned.path);
    double slivers = 0.0;
    for (const auto& [name, count] : planned.stats.counts) {
        slivers = name == "sliver_points" ? count : slivers;
    }
    std::printf("roughing seed %u: %d levels, %.0f slivers, rapid moves %.4f mm deep\n", seed,
                planned.stats.levels, slivers, deep);
    return deep > 0.01 ? "seed " + std::to_string(seed) + ": a rapid move is " +
                             std::to_string(deep) + " mm deep in stock"
                       : "";
}

std::string wrong_of_block(unsigned seed)
{
    Random random{seed};
    const Job job = block_with_floor(random);
    const offset::Box2d box{(*job.stock_x)[0], (*job.stock_y)[0], (*job.stock_x)[1],
                            (*job.stock_y)[1]};
    const auto planned = adaptive_isocurve::plan_waterline_roughing(job, job.operations.front());
    return wrong_of(seed, {box, job.stock_top}, planned.front());
}

}  // namespace

TEST_GROUP(RapidsOfRoughing){};

TEST(RapidsOfRoughing, MeetNoStock)
{
    STRCMP_EQUAL("", broken_cases(property_seed(4801), property_cases(3), wrong_of_block).c_str());
}

}  // namespace cusp::test
