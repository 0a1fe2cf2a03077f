// Jobs that cannot be planned are refused with name, value and limit.
#include "CppUTest/TestHarness.h"

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "tests/support/refusal.hpp"
#include "tests/unit/adaptive_isocurve/small_models.hpp"

using namespace cusp;
using namespace cusp::adaptive_isocurve;
using namespace cusp::job;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

void refused(const Job& job, const char* word)
{
    const std::string text =
        test::refusal([&] { plan_adaptive_isocurve(job, job.operations.front()); });
    STRCMP_CONTAINS(word, text.c_str());
}

}  // namespace

TEST_GROUP(SurfaceOperation)
{
    std::mt19937 random{5};
    Job job = job_for({bumps(random, 6), wall(9, 9)}, cusp::adaptive_isocurve::kAdaptiveIsocurve);
    Operation& operation = job.operations.front();
};

TEST(SurfaceOperation, RefusesAnotherEndThanABallOverSurfaces)
{
    operation.tool = {1, ToolShape::kFlat, 2, 0};
    const std::string text =
        test::refusal([&] { plan_complete_isocurves(job, job.operations.front()); });
    STRCMP_CONTAINS("finishes with a ball", text.c_str());
}

TEST(SurfaceOperation, RefusesASurfaceWithoutArea)
{
    for (Vec3d& p : operation.part.floor.front().points) {
        p = {1, 1, 1};
    }
    refused(job, "degenerate");
}

TEST(SurfaceOperation, RefusesAPartOverTheClearanceHeight)
{
    job.stock_top = 1;
    refused(job, "clearance height");
}

TEST(SurfaceOperation, RefusesToGuessASpacing)
{
    operation.tolerance.scallop.reset();
    refused(job, "iso_distance or scallop");
}

TEST(SurfaceOperation, RefusesMorePassesThanAnyoneWouldWaitFor)
{
    for (Vec3d& p : operation.part.floor.front().points) {
        p = p * 2000.0;
    }
    operation.tolerance.scallop = 0.03;
    refused(job, "scallop is 0.03 mm, that is passes 0.69");
    refused(job, "over a part of 40000 mm these would be");
    refused(job, "at most 20000 are made");
}

TEST(SurfaceOperation, RefusesKeysOfRoughingWithoutIt)
{
    operation.passes.allowance = 0.3;
    refused(job, "allowance is 0.3 mm");
    operation.passes.allowance = 0;
    operation.levels.max_depth = 2.0;
    refused(job, "max_depth");
    operation.levels.max_depth.reset();
    operation.tools = {{2, ToolShape::kFlat, 3, 0}};
    refused(job, "tools names the tools that rough");
    operation.passes.roughing = true;
    operation.levels.max_depth = 1e-4;
    refused(job, "max_depth is 0.0001 mm");
    operation.levels.max_depth = 2.0;
    operation.levels.layers = {4.0, 4.5};
    refused(job, "deep, more than max_depth, 2 mm");
    operation.levels.max_depth = 20.0;
    operation.levels.min_depth = 1.0;
    refused(job, "is 0.5 mm deep, less than min_depth, 1 mm");
}
