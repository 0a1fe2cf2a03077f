// Level ground: a flat end cuts it to size, a ball has no pass on it.
#include "host_tools/cam/adaptive_isocurve/level_floors.hpp"

#include <algorithm>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/generators/random_jobs.hpp"
#include "tests/judges/height_raster.hpp"
#include "tests/support/plates.hpp"

using namespace cusp;
using namespace cusp::adaptive_isocurve;
using namespace cusp::job;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

constexpr Tool kFlatEnd{1, ToolShape::kFlat, 3, 0};
constexpr Tool kBallEnd{2, ToolShape::kBall, 2, 2};

// Ground 40 x 30 mm, 5.3 mm under the stock's top; a step 2 mm under it takes the part from x = 25 on.
Job step_job()
{
    Operation operation;
    operation.strategy = &cusp::adaptive_isocurve::kAdaptiveIsocurve;
    operation.passes.roughing = true;
    operation.passes.allowance = 0.3;
    operation.part.floor = {plate(0, 0, 25, 30, -5.3), plate(25, 0, 40, 30, -2)};
    operation.tools = {kFlatEnd};
    operation.tool = kBallEnd;
    operation.levels.max_depth = 2.5;
    operation.tolerance.plan = operation.tolerance.floor = 0.01;
    operation.tolerance.scallop = 0.05;
    return job_of(operation);
}

// Stock on the floor at a place: its least height over all straight cuts that reach it, by brute force.
double height_at(const std::vector<PlannedOperation>& planned, Vec2d place, double top)
{
    double height = top;
    for (const PlannedOperation& one : planned) {
        Vec3d at = end_of(one.path.moves.front());
        for (const ToolMove& move : one.path.moves) {
            for (const Vec3d to : points_of(move, at, 1e-3)) {
                const Vec2d way = in_plan(to - at);
                const double square = dot(way, way);
                const double share =
                    square > 0 ? std::clamp(dot(place - in_plan(at), way) / square, 0.0, 1.0) : 0.0;
                const double away = norm(place - in_plan(at) - way * share);
                if (away <= one.path.tool.radius) {
                    height = std::min(
                        height, at.z + (to.z - at.z) * share + profile_height(one.path.tool, away));
                }
                at = to;
            }
        }
    }
    return height;
}

double cut_length_of(const PlannedOperation& planned)
{
    return measure(planned.path, {}).cut_length_mm;
}

// mm: the deepest cut of a flat end on a raster of the stock.
double deepest_cut(const PlannedOperation& planned)
{
    constexpr double kStep = 0.1;
    HeightRaster stock{{0, 0, 40, 30}, 0, kStep};
    double deepest = 0;
    Vec3d at = end_of(planned.path.moves.front());
    for (const ToolMove& move : planned.path.moves) {
        for (const Vec3d to : points_of(move, at, 1e-3)) {
            const int n = 1 + static_cast<int>(norm(to - at) / kStep);
            for (int i = 1; i <= n; ++i) {
                const Vec3d tip = at + (to - at) * (static_cast<double>(i) / n);
                deepest = std::max(deepest, stock.cut(tip, planned.path.tool.radius, 0.005));
            }
            at = to;
        }
    }
    return deepest;
}

void check_step(const Job& job)
{
    const std::vector<PlannedOperation> planned =
        plan_adaptive_isocurve(job, job.operations.front());
    UNSIGNED_LONGS_EQUAL(2, planned.size());
    const std::vector<PlannedOperation> rough{planned.front()};
    for (double x = 1.0; x < 40; x += 1.7) {
        const double floor = x < 25 ? -5.3 : -2.0;
        for (double y = 1.0; y < 30; y += 1.7) {
            // The foot of the wall: the flat end leaves the allowance there, the ball a fillet.
            if (x < 24.3 || x > 25) {
                DOUBLES_EQUAL(floor, height_at(rough, {x, y}, 0), 1e-6);
            }
            CHECK(height_at(planned, {x, y}, 0) > floor - 1e-6);
        }
    }
    CHECK(deepest_cut(planned.front()) <= 2.5 + 1e-3);
    // After a ball that roughs, the ball finishes the floors too.
    Operation ball_alone = job.operations.front();
    ball_alone.tools = {kBallEnd};
    const double all_over = cut_length_of(plan_adaptive_isocurve(job, ball_alone).back());
    CHECK(cut_length_of(planned.back()) < 0.2 * all_over);
}

}  // namespace

TEST_GROUP(LevelFloors){};

TEST(LevelFloors, OfSurfacesAreCutToSizeByTheFlatEnd) { check_step(step_job()); }

TEST(LevelFloors, OfMeshesAreCutToSizeByTheFlatEnd)
{
    Job job = step_job();
    CutPart& part = job.operations.front().part;
    for (const nurbs::Surface& surface : part.floor) {
        const std::vector<Vec3d>& p = surface.points;
        part.mesh.push_back({p[0], p[2], p[3]});
        part.mesh.push_back({p[0], p[3], p[1]});
    }
    part.mesh.push_back({Vec3d{25, 0, -5.3}, Vec3d{25, 30, -5.3}, Vec3d{25, 30, -2}});
    part.mesh.push_back({Vec3d{25, 0, -5.3}, Vec3d{25, 30, -2}, Vec3d{25, 0, -2}});
    part.floor.clear();
    check_step(job);
}

TEST(LevelFloors, KeepABoundOfTheEngagement)
{
    Job job = step_job();
    job.operations.front().passes.max_engagement = 70;
    check_step(job);
}

TEST(LevelFloors, LeaveTheAllowanceOnWallsAndNothingElse)
{
    const Job job = step_job();
    const LevelFloors floors = level_floors(job, job.operations.front());
    UNSIGNED_LONGS_EQUAL(2, floors.levels().size());
    const LevelFloor& low = floors.levels().back();
    DOUBLES_EQUAL(-5.3, low.z, 0);
    CHECK(low.centres->clearance({25 - 3 - 0.6, 15}) > 0);
    CHECK(low.centres->clearance({25 - 3 - 0.3, 15}) < 0);
    CHECK(floors.is_free({5, 5, -5.3}, {20, 5, -5.3}, 2));
    CHECK(!floors.is_free({5, 5, -5.301}, {20, 5, -5.3}, 2));
    CHECK(!floors.is_free({5, 5, -5.3}, {23, 5, -5.3}, 2));
}

TEST(LevelFloors, NeedAFlatEndAndRoughing)
{
    Job job = step_job();
    job.operations.front().tools = {{1, ToolShape::kBull, 3, 0.5}};
    CHECK(level_floors(job, job.operations.front()).levels().empty());
    job = step_job();
    job.operations.front().passes.roughing = false;
    CHECK(level_floors(job, job.operations.front()).levels().empty());
}

TEST(LevelFloors, OnTheStocksTopOrUnderItsBottomAreNone)
{
    Job job = step_job();
    job.stock_top = -2;
    job.stock_bottom = -5;
    CHECK(level_floors(job, job.operations.front()).levels().empty());
}
