// The case study of Suh & Lee 1990 on our replica of its part, and the numbers we promise for it.
#include <cmath>

#include "host_tools/cam/contour_pocket/contour_pocket.hpp"
#include "host_tools/job/import/import.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace contour_pocket;
using namespace import;
using namespace job;
using namespace toolpath;

namespace {

std::string part(const char* name)
{
    return std::string{CUSP_SOURCE_DIR "/examples/parts/suh-lee-"} + name + ".json";
}

Job job()
{
    Job job;
    job.file = "suh-lee.toml";
    job.stock_top = 0.0;
    job.clearance = 5.0;
    return job;
}

Operation replica()
{
    Operation operation;
    operation.strategy = &cusp::contour_pocket::kContourPocket;
    operation.part.floor_files = {part("floor")};
    operation.part.floor = read_surfaces(part("floor"));
    operation.outline.boundary_file = part("boundary");
    operation.outline.boundary = read_loop(part("boundary"));
    operation.outline.island_files = {part("island")};
    operation.outline.islands = {read_loop(part("island"))};
    operation.tool = {1, ToolShape::kBall, 6.0, 6.0};
    operation.tolerance.scallop = 0.4;
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    return operation;
}

Operation papers_way()
{
    Operation operation = replica();
    operation.tolerance.plan = operation.tolerance.floor = 0.5;
    operation.tolerance.side = ToleranceSide::kBoth;
    return operation;
}

TEST_GROUP(SuhLee){};

TEST(SuhLee, TakesTenLevelsAndTwentyOneLoopsThePapersWay)
{
    const OperationStats stats = plan_contour_pocket(job(), papers_way()).back().stats;
    LONGS_EQUAL(10, stats.levels);
    LONGS_EQUAL(21, stats.passes);
}

TEST(SuhLee, NeedsAtMost416PointsWithLinesAnd250WithArcs)
{
    Operation operation = papers_way();
    CHECK(plan_contour_pocket(job(), operation).back().stats.cl_points <= 416);
    operation.output = OutputForm::kArcs;
    CHECK(plan_contour_pocket(job(), operation).back().stats.cl_points <= 250);
}

TEST(SuhLee, StaysWithinBothTolerancesThePapersWay)
{
    const OperationStats stats = plan_contour_pocket(job(), papers_way()).back().stats;
    CHECK(stats.gouge_bound_mm <= 0.5);
}

TEST(SuhLee, NeverGougesFromOutside)
{
    for (const OutputForm output : {OutputForm::kLines, OutputForm::kArcs}) {
        Operation operation = replica();
        operation.output = output;
        const OperationStats stats = plan_contour_pocket(job(), operation).back().stats;
        DOUBLES_EQUAL(0.0, stats.gouge_bound_mm, 0.0);
        CHECK(stats.scallop_bound_mm <= 0.4 + 1e-12);
    }
}

TEST(SuhLee, RetractsAtMostOncePerLeafAndIsland)
{
    const OperationStats stats = plan_contour_pocket(job(), replica()).back().stats;
    double allowed = 0.0;
    for (const auto& [name, count] : stats.counts) {
        allowed += name == "leaves" || name == "islands" ? count : 0.0;
    }
    CHECK(stats.retracts <= static_cast<int>(allowed));
}

}  // namespace
}  // namespace cusp::test
