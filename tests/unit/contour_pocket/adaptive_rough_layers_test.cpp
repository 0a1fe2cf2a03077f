// Bounded engagement over floors that are level, and over others.
#include <algorithm>
#include <string>
#include <vector>

#include "host_tools/cam/contour_pocket/contour_pocket.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/job/job/level_floor.hpp"
#include "host_tools/job/job/operation_check.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace contour_pocket;
using namespace job;
using namespace toolpath;

namespace {

nurbs::Curve wall_line(Vec2d a, Vec2d b)
{
    return {1, {0.0, 0.0, 1.0, 1.0}, {{a.x, a.y, 0.0}, {b.x, b.y, 0.0}}, {1.0, 1.0}};
}

// 50 x 50 mm, 8 mm deep, in stock up to z = 0.
Operation ball_pocket()
{
    Operation operation;
    operation.strategy = &kContourPocket;
    nurbs::Surface floor;
    floor.degree_u = floor.degree_v = 1;
    floor.size_u = floor.size_v = 2;
    floor.knots_u = floor.knots_v = {0.0, 0.0, 1.0, 1.0};
    floor.points = {{0, 0, -8}, {0, 60, -8}, {60, 0, -8}, {60, 60, -8}};
    floor.weights = {1.0, 1.0, 1.0, 1.0};
    operation.part.floor = {floor};
    operation.part.floor_files = {"floor.json"};
    operation.outline.boundary = Loop{wall_line({5, 5}, {55, 5}), wall_line({55, 5}, {55, 55}),
                                      wall_line({55, 55}, {5, 55}), wall_line({5, 55}, {5, 5})};
    operation.outline.boundary_file = "boundary.json";
    operation.tool = {1, ToolShape::kBall, 4.0, 4.0};
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    operation.tolerance.scallop = 0.3;
    return operation;
}

Job stock_job()
{
    Job job;
    job.file = "job.toml";
    job.clearance = 5.0;
    return job;
}

double lowest_z(const Toolpath& path)
{
    double lowest = kUnbounded;
    for (const ToolMove& move : path.moves) {
        lowest = std::min(lowest, end_of(move).z);
    }
    return lowest;
}

// The reasons for which an adaptive operation is refused.
std::string why_refused(const Operation& operation)
{
    std::string text;
    check_pocket(operation, [&](const char* key, const std::string& why) {
        text += std::string{key} + ": " + why + "\n";
    });
    return text;
}

}  // namespace

TEST_GROUP(AdaptiveRoughing)
{
    Operation operation{ball_pocket()};

    void setup() override
    {
        operation.tools = {{2, ToolShape::kFlat, 4.0, 0.0}};
        operation.levels.max_depth = 6.0;
        operation.passes.max_engagement = 60.0;
        operation.passes.allowance = 0.3;
    }
};

TEST(AdaptiveRoughing, KnowsLevelFloors)
{
    DOUBLES_EQUAL(-8.0, level_floor(operation).value(), 0.0);
    operation.part.floor.front().points[3].z = -8.0001;
    CHECK(!level_floor(operation));
    operation.part.floor.clear();
    CHECK(!level_floor(operation));
}

TEST(AdaptiveRoughing, CutsLevelFloorsToSizeWithOneFlatEnd)
{
    STRCMP_CONTAINS("clearing: \"adaptive\" needs a flat end", why_refused(operation).c_str());
    STRCMP_CONTAINS("tools: has more than", why_refused(operation).c_str());
    STRCMP_CONTAINS("allowance: does not go with", why_refused(operation).c_str());
    operation.part.floor.front().points[3].z = -9.0;
    STRCMP_EQUAL("", why_refused(operation).c_str());
    operation.levels.max_depth.reset();
    STRCMP_CONTAINS("clearing: \"adaptive\" needs max_depth or layers",
                    why_refused(operation).c_str());
}

TEST(AdaptiveRoughing, KeepsItsBoundOnASlopeAndLeavesTwoStepsAtMost)
{
    operation.part.floor.front().points[3].z = -9.0;
    const std::vector<PlannedOperation> planned = plan_contour_pocket(stock_job(), operation);
    LONGS_EQUAL(2, planned.size());
    const OperationStats& roughed = planned.front().stats;
    CHECK(roughed.roughing);
    CHECK(roughed.levels > 2);
    CHECK(roughed.scallop_bound_mm > 0.3 + 2 * 0.2 * 6.0);
    CHECK(roughed.scallop_bound_mm < 0.35 + 2 * 0.2 * 6.0);
    double bound = 0.0;
    for (const auto& [name, count] : roughed.counts) {
        bound = name == "engagement_bound_deg" ? count : bound;
    }
    CHECK(bound > 40.0);
    CHECK(bound <= 60.0);
    CHECK(lowest_z(planned.front().path) > lowest_z(planned.back().path) + 0.3);
}

}  // namespace cusp::test
