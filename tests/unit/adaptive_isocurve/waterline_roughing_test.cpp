// Depths of levels, and what smaller cutters remove after larger ones.
#include "host_tools/cam/adaptive_isocurve/waterline_roughing.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/adaptive_isocurve/rest_regions.hpp"
#include "host_tools/cam/adaptive_isocurve/rough_depths.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/generators/random_jobs.hpp"
#include "tests/support/plates.hpp"

using namespace cusp;
using namespace cusp::adaptive_isocurve;
using namespace cusp::clearing;
using namespace cusp::job;
using namespace cusp::offset;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

constexpr Tool kFlat10{1, ToolShape::kFlat, 5, 0};
constexpr Tool kFlat3{2, ToolShape::kFlat, 1.5, 0};
constexpr Tool kBall6{3, ToolShape::kBall, 3, 3};

// A square channel 6 mm wide beside a field 25 mm wide, between plates 6 mm high.
Job channel_job()
{
    Operation operation;
    operation.strategy = &cusp::adaptive_isocurve::kAdaptiveIsocurve;
    operation.passes.roughing = true;
    operation.part.floor = {plate(0, 0, 41, 30, -6), plate(25, 0, 30, 30, 0),
                            plate(36, 0, 41, 30, 0)};
    operation.tools = {kFlat10};
    operation.levels.max_depth = 2.5;
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    return job_of(operation);
}

double cut_length(const PlannedOperation& planned)
{
    return measure(planned.path, {}).cut_length_mm;
}

// In micrometres, of the ends of cuts.
std::set<long> cut_heights(const PlannedOperation& planned)
{
    std::set<long> heights;
    for (const ToolMove& move : planned.path.moves) {
        if (move.kind == MoveKind::kCut) {
            heights.insert(std::lround(1000 * end_of(move).z));
        }
    }
    return heights;
}

// Plans the job with a ball of 4 mm, and looks for the reason why nothing is roughed.
void finish_says(const char* why, Job job)
{
    Operation& operation = job.operations.front();
    operation.tool = {3, ToolShape::kBall, 2, 2};
    operation.tolerance.scallop = 0.3;
    const auto planned = plan_adaptive_isocurve(job, operation);
    CHECK_EQUAL(1U, planned.size());
    CHECK_EQUAL(3, planned.front().path.tool.number);
    STRCMP_CONTAINS(why, planned.front().stats.warnings.back().c_str());
}

}  // namespace

TEST_GROUP(WaterlineRoughing){};

TEST(WaterlineRoughing, ASmallerCutterTakesOnlyWhatTheLargerOneCouldNotReach)
{
    Job job = channel_job();
    Operation& operation = job.operations.front();
    const auto large = plan_waterline_roughing(job, operation);
    operation.tools = {kFlat3};
    const auto small = plan_waterline_roughing(job, operation);
    operation.tools = {kFlat3, kFlat10};
    const auto both = plan_waterline_roughing(job, operation);
    CHECK_EQUAL(2U, both.size());
    CHECK_EQUAL(1, both.front().path.tool.number);
    CHECK_EQUAL(2, both.back().path.tool.number);
    CHECK(cut_heights(large.front()) == cut_heights(both.front()));
    // Only the channel is left: 6 of 41 mm.
    CHECK(cut_length(both.back()) < 0.35 * cut_length(small.front()));
    for (const ToolMove& move : both.back().path.moves) {
        const Vec3d at = end_of(move);
        CHECK(move.kind != MoveKind::kCut || (at.x > 29 && at.x < 37));
    }
}

// A boss on a plate: the outermost pass of each level keeps off the stock, and its corners too.
TEST(WaterlineRoughing, NoPassRunsBesideTheStock)
{
    Job job = channel_job();
    Operation& operation = job.operations.front();
    operation.part.floor = {plate(0, 0, 60, 40, -6), plate(25, 15, 35, 25, 0)};
    const PlannedOperation planned = plan_waterline_roughing(job, operation).front();
    const auto is_beside = [](Vec3d at) {
        return std::hypot(std::max({-at.x, at.x - 60, 0.0}), std::max({-at.y, at.y - 40, 0.0})) >=
               kFlat10.radius;
    };
    double beside = 0;
    Vec3d at = end_of(planned.path.moves.front());
    for (const ToolMove& move : planned.path.moves) {
        const Vec3d to = end_of(move);
        if (move.kind == MoveKind::kCut && is_beside(at) && is_beside(to) &&
            is_beside(0.5 * (at + to))) {
            beside += norm(to - at);
        }
        at = to;
    }
    CHECK(beside < 0.02 * cut_length(planned));
}

TEST(WaterlineRoughing, ACutterThatFindsNothingIsNamedAndLeftOut)
{
    Job job = channel_job();
    Operation& operation = job.operations.front();
    operation.part.floor = {plate(0, 0, 40, 30, -6)};
    operation.tools = {kFlat10, kFlat3};
    const auto planned = plan_waterline_roughing(job, operation);
    CHECK_EQUAL(1U, planned.size());
    STRCMP_CONTAINS("tool 2 fits nowhere", planned.front().stats.warnings.front().c_str());
}

TEST(WaterlineRoughing, ACutterThatFitsNowhereLeavesAllToTheSmallerOne)
{
    Job job = channel_job();
    Operation& operation = job.operations.front();
    job.stock_x = {{0, 41}};
    operation.part.floor = {plate(-20, -20, 60, 20, -6), plate(-20, -20, -2.5, 20, 0),
                            plate(2.5, -20, 60, 20, 0), plate(-3, -20, 3, -10, 0),
                            plate(-3, 10, 3, 20, 0)};
    operation.tools = {{1, ToolShape::kFlat, 12, 0}, kFlat3};
    const auto planned = plan_waterline_roughing(job, operation);
    CHECK_EQUAL(2, planned.back().path.tool.number);
}

TEST(WaterlineRoughing, DepthsAreEqualAndTheirRidgesKeepThemWithinMaxDepth)
{
    const Job job = channel_job();
    Operation operation = job.operations.front();
    for (const Tool& tool : {kFlat3, kBall6}) {
        for (double deep = 1.0; deep < 20; deep += 0.37) {
            const RoughDepths depths = rough_depths(job, operation, {tool}, 0, -deep);
            double above = 0;
            for (const double z : depths.heights) {
                CHECK(above - z + (tool.corner_radius > 0 ? depths.scallop_height : 0) <= 2.5);
                DOUBLES_EQUAL(depths.thinnest, above - z, 1e-9);
                above = z;
            }
            DOUBLES_EQUAL(-deep, above, 1e-9);
        }
    }
}

// 4.9 mm in levels of at most 2.5: with the scallops of a ball there would be three.
TEST(WaterlineRoughing, MinDepthLowersRidgesWhereLevelsWouldElseBeThinner)
{
    const Job job = channel_job();
    Operation operation = job.operations.front();
    CHECK_EQUAL(3U, rough_depths(job, operation, {kBall6}, 0, -4.8).heights.size());
    operation.levels.min_depth = 2.2;
    const RoughDepths depths = rough_depths(job, operation, {kBall6}, 0, -4.8);
    CHECK_EQUAL(2U, depths.heights.size());
    CHECK(depths.scallop_height > 0.04);
    CHECK(depths.thinnest + depths.scallop_height <= 2.5);
    // Two levels of 2.6 would be deeper than max_depth, which has priority over min_depth.
    DOUBLES_EQUAL(5.2 / 3, rough_depths(job, operation, {kFlat3}, 0, -5.2).thinnest, 1e-9);
}

TEST(WaterlineRoughing, TellsWhereMinDepthCanNotBeKept)
{
    Job job = channel_job();
    Operation& operation = job.operations.front();
    operation.levels.max_depth = 4.0;
    operation.levels.min_depth = 3.5;
    const auto planned = plan_waterline_roughing(job, operation);
    STRCMP_CONTAINS("less than min_depth, 3.5 mm", planned.front().stats.warnings.front().c_str());
}

TEST(WaterlineRoughing, RestPartsAreWhatLeavesTheClearedPlaces)
{
    Region2d square;
    square.contours = {{line_edge({0, 0}, {10, 0}), line_edge({10, 0}, {10, 10}),
                        line_edge({10, 10}, {0, 10}), line_edge({0, 10}, {0, 0})}};
    const RegionOffset region{square};
    const std::vector<LayerRun> runs{{{line_edge({-5, 5}, {25, 5})}, false}};
    const auto rest = rest_regions(runs, 1.0, {{&region, 2.0}});
    CHECK_EQUAL(2U, rest.size());
    const Edge& before = rest[0].edges.front();
    const Edge& after = rest[1].edges.front();
    DOUBLES_EQUAL(-2, before.end.x, 5e-3);
    CHECK(before.end.x >= -2);
    DOUBLES_EQUAL(12, after.start.x, 5e-3);
    CHECK(after.start.x <= 12);
    CHECK(!rest[0].starts_in_cleared_stock);
    CHECK(rest[1].starts_in_cleared_stock);
    CHECK_EQUAL(1U, rest_regions(runs, 8.0, {{&region, 2.0}}).size());
}

// The stock over the floor is less than the allowance.
TEST(WaterlineRoughing, WhereTheStockIsLowerThanTheAllowanceOnlyTheFinishIsPlanned)
{
    Job job = channel_job();
    Operation& operation = job.operations.front();
    operation.part.floor = {plate(0, 0, 41, 30, -0.2)};
    operation.passes.allowance = 0.3;
    job.stock_top = 0;
    CHECK(plan_waterline_roughing(job, operation).front().path.moves.empty());
    finish_says("the lowest level is at z = 0.1 mm, the stock's top at 0 mm", job);
}

// A closed slot 6 mm wide in a plate, too narrow for 10 mm.
TEST(WaterlineRoughing, WhereNoCutterFitsOnlyTheFinishIsPlanned)
{
    Job job = channel_job();
    Operation& operation = job.operations.front();
    operation.part.floor = {plate(0, 0, 41, 30, -6), plate(0, 0, 20, 30, 0),
                            plate(26, 0, 41, 30, 0), plate(19, 0, 27, 8, 0),
                            plate(19, 22, 27, 30, 0)};
    job.stock_top = 0;
    operation.passes.allowance = 0.3;
    CHECK(plan_waterline_roughing(job, operation).front().path.moves.empty());
    finish_says("no roughing tool fits into the stock with an allowance of 0.3 mm", job);
}
