// Chuang & Pan: what the paper prints of its tap, from the job in examples/hull_rough.
#include <map>
#include <memory>
#include <variant>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/hull_rough/hull_rough.hpp"
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/job/job/job.hpp"
#include "tests/support/test_jobs.hpp"

using namespace cusp::hull_rough;
using namespace cusp::import;
using namespace cusp::job;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

PlannedOperation tap(int extra_subdivision)
{
    Job job = read_job(CUSP_SOURCE_DIR "/examples/hull_rough/tap.toml", cusp::strategies::all());
    cusp::hull_rough::hull_keys(job.operations.front()).extra_subdivision = extra_subdivision;
    return plan_hull_rough(job, job.operations.front()).front();
}

constexpr double kStock = 104832;
constexpr double kPart = 22604;  // mm^3, by integration of the surface

}  // namespace

TEST_GROUP(ChuangPaper){};

TEST(ChuangPaper, TapIsCutInFifteenLayers)
{
    const PlannedOperation plan = tap(0);
    DOUBLES_EQUAL(15, count_of(plan, "layers"), 0);
    DOUBLES_EQUAL(1.012, count_of(plan, "thinnest_layer_mm"), 5e-4);
    DOUBLES_EQUAL(1.838, count_of(plan, "thickest_layer_mm"), 5e-4);
    DOUBLES_EQUAL(kStock, count_of(plan, "stock_mm3"), 0.1);
}

TEST(ChuangPaper, BoxesToTheirOwnTopsRemoveThreeQuartersOfWhatCanBeRemoved)
{
    // The 33 slices before thin ones are merged, which raises tops to the layer above.
    Job job = read_job(CUSP_SOURCE_DIR "/examples/hull_rough/tap.toml", cusp::strategies::all());
    cusp::hull_rough::hull_keys(job.operations.front()).extra_subdivision = 0;
    job.operations.front().levels.min_depth = 0;
    const PlannedOperation plan = plan_hull_rough(job, job.operations.front()).front();
    DOUBLES_EQUAL(33, count_of(plan, "layers"), 0);
    const double removed = kStock - count_of(plan, "left_under_boxes_mm3");
    DOUBLES_EQUAL(0.748, removed / (kStock - kPart), 1e-3);
}

TEST(ChuangPaper, FinerHullsLeaveFivePercentOfWhatCanBeRemoved)
{
    const PlannedOperation plan = tap(3);
    CHECK(count_of(plan, "layers") <= 17);
    CHECK(count_of(plan, "left_under_boxes_mm3") - kPart <= 0.045 * (kStock - kPart));
}
