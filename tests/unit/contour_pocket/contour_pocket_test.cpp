#include "host_tools/cam/contour_pocket/contour_pocket.hpp"

#include <algorithm>
#include <functional>
#include <map>

#include "host_tools/cam/contour_pocket/pocket_task.hpp"
#include "tests/support/recorded_progress.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/test_jobs.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace contour_pocket;
using namespace job;
using namespace nurbs;
using namespace toolpath;

namespace {

Curve line_curve(Vec2d a, Vec2d b)
{
    return {1, {0.0, 0.0, 1.0, 1.0}, {{a.x, a.y, 0.0}, {b.x, b.y, 0.0}}, {1.0, 1.0}};
}

Loop square_loop(double x, double y, double half)
{
    const Vec2d p[] = {
        {x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}};
    return {line_curve(p[0], p[1]), line_curve(p[1], p[2]), line_curve(p[2], p[3]),
            line_curve(p[3], p[0])};
}

Surface plane(double size, double z)
{
    Surface s;
    s.degree_u = s.degree_v = 1;
    s.size_u = s.size_v = 2;
    s.knots_u = s.knots_v = {0.0, 0.0, 1.0, 1.0};
    s.points = {{0.0, 0.0, z}, {0.0, size, z}, {size, 0.0, z}, {size, size, z}};
    s.weights = {1.0, 1.0, 1.0, 1.0};
    return s;
}

Job job()
{
    Job job;
    job.file = "job.toml";
    job.clearance = 5.0;
    return job;
}

Operation pocket()
{
    Operation operation;
    operation.strategy = &cusp::contour_pocket::kContourPocket;
    operation.part.floor = {plane(60.0, -8.0)};
    operation.part.floor_files = {"floor.json"};
    operation.outline.boundary = square_loop(30.0, 30.0, 25.0);
    operation.outline.boundary_file = "boundary.json";
    operation.tool = {1, ToolShape::kBall, 4.0, 4.0};
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    operation.tolerance.scallop = 0.3;
    return operation;
}

std::string refusal(const std::function<void(Operation&)>& spoil)
{
    Operation operation = pocket();
    spoil(operation);
    return test::refusal([&] { plan_contour_pocket(job(), operation); });
}

bool says(const std::string& text, const char* part)
{
    return text.find(part) != std::string::npos;
}

double lowest_tip(const Toolpath& path)
{
    double lowest = 1e300;
    for (const ToolMove& move : path.moves) {
        if (const auto* line = std::get_if<LineTo>(&move.shape)) {
            lowest = std::min(lowest, line->end.z);
        }
    }
    return lowest;
}

TEST_GROUP(ContourPocket){};

TEST(ContourPocket, CutsAFlatFloorJustAboveIt)
{
    for (const double corner : {4.0, 1.0, 0.0}) {
        Operation operation = pocket();
        operation.tool.corner_radius = corner;
        operation.tool.shape = corner == 4.0   ? ToolShape::kBall
                               : corner == 0.0 ? ToolShape::kFlat
                                               : ToolShape::kBull;
        const double lowest = lowest_tip(plan_contour_pocket(job(), operation).back().path);
        CHECK(lowest >= -8.0);
        CHECK(lowest <= -8.0 + 0.02);
    }
}

TEST(ContourPocket, StartsAndEndsAtClearance)
{
    const Toolpath path = plan_contour_pocket(job(), pocket()).back().path;
    CHECK(path.moves.front().kind == MoveKind::kRapid);
    DOUBLES_EQUAL(5.0, std::get<LineTo>(path.moves.front().shape).end.z, 1e-9);
    DOUBLES_EQUAL(5.0, std::get<LineTo>(path.moves.back().shape).end.z, 1e-9);
}

TEST(ContourPocket, RoughsInLayersNoDeeperThanAskedFor)
{
    Operation operation = pocket();
    operation.levels.max_depth = 2.0;
    operation.passes.allowance = 0.2;
    const std::vector<PlannedOperation> planned = plan_contour_pocket(job(), operation);
    LONGS_EQUAL(2, planned.size());
    double layers = 0.0;
    for (const auto& [name, count] : planned.front().stats.counts) {
        layers = name == "layers" ? count : layers;
    }
    CHECK(layers >= 4.0);
    CHECK(lowest_tip(planned.front().path) >= -8.0 + 0.2);
}

TEST(ContourPocket, ClearsAdaptivelyInLayersDownToALevelFloor)
{
    Operation operation = pocket();
    operation.outline.boundary = square_loop(30.0, 30.0, 11.0);
    operation.tool = {1, ToolShape::kFlat, 4.0, 0.0};
    operation.passes.max_engagement = 60.0;
    operation.levels.max_depth = 4.0;
    const std::vector<PlannedOperation> planned = plan_contour_pocket(job(), operation);
    LONGS_EQUAL(1, planned.size());
    LONGS_EQUAL(2, planned.front().stats.levels);
    DOUBLES_EQUAL(-8.0, lowest_tip(planned.front().path), 1e-9);
    double bound = 0.0;
    for (const auto& [name, count] : planned.front().stats.counts) {
        bound = name == "engagement_bound_deg" ? count : bound;
    }
    CHECK(bound > 40.0);
    CHECK(bound <= 60.0);
}

TEST(ContourPocket, TellsItsProgressThroughRoughingAndFinish)
{
    Operation operation = pocket();
    operation.levels.max_depth = 2.0;
    operation.passes.allowance = 0.2;
    Job planned = job();
    const test::RecordedProgress progress{planned};
    plan_contour_pocket(planned, operation);
    CHECK(progress.rises(0.3));
}

// The largest depth of cutting moves below all earlier cuts at their place, sampled along the
// moves.
double deepest_first_cut(const std::vector<PlannedOperation>& planned, double top)
{
    std::map<std::pair<int, int>, double> heights;
    double deepest = 0.0;
    for (const PlannedOperation& operation : planned) {
        Vec3d at{};
        for (const ToolMove& move : operation.path.moves) {
            const Vec3d to = std::get<LineTo>(move.shape).end;
            const int n = 1 + static_cast<int>(norm(to - at) / 0.2);
            for (int i = 1; i <= n && move.kind == MoveKind::kCut; ++i) {
                const Vec3d p = at + (to - at) * (static_cast<double>(i) / n);
                const std::pair cell{static_cast<int>(p.x), static_cast<int>(p.y)};
                double& height = heights.emplace(cell, top).first->second;
                deepest = std::max(deepest, height - p.z);
                height = std::min(height, p.z);
            }
            at = to;
        }
    }
    return deepest;
}

TEST(ContourPocket, TheFinishKeepsFartherOffTheWallsThanARoughingWithoutAllowance)
{
    for (const ToleranceSide side : {ToleranceSide::kOutside, ToleranceSide::kBoth}) {
        Operation operation = pocket();
        operation.tolerance.side = side;
        operation.levels.max_depth = 3.0;
        const Job around = job();
        const Pocket pocket{around, operation};
        const auto [roughed, finished] = split_between_rough_and_finish(pocket);
        const ToleranceSplit& whole = pocket.tolerances;
        const ToleranceSplit& rough = roughed.tolerances;
        const ToleranceSplit& finish = finished.tolerances;
        CHECK(rough.plan_tolerance > 1e-4);
        CHECK(rough.wall_clearance + rough.plan_tolerance <
              finish.wall_clearance - finish.plan_tolerance);
        DOUBLES_EQUAL(whole.wall_clearance - whole.plan_tolerance,
                      rough.wall_clearance - rough.plan_tolerance, 1e-12);
        DOUBLES_EQUAL(whole.wall_clearance + whole.plan_tolerance,
                      finish.wall_clearance + finish.plan_tolerance, 1e-12);
        operation.passes.allowance = 0.3;
        DOUBLES_EQUAL(whole.wall_clearance,
                      split_between_rough_and_finish(pocket).rough.tolerances.wall_clearance, 0);
        DOUBLES_EQUAL(whole.plan_tolerance,
                      split_between_rough_and_finish(pocket).finish.tolerances.plan_tolerance, 0);
    }
}

TEST(ContourPocket, CutsInLayersWhereTheRoughingToolDoesNotFit)
{
    Operation operation = pocket();
    operation.levels.max_depth = 2.0;
    operation.tools = {{2, ToolShape::kFlat, 30.0, 0.0}, operation.tool};
    const std::vector<PlannedOperation> planned = plan_contour_pocket(job(), operation);
    LONGS_EQUAL(1, planned.size());
    CHECK(deepest_first_cut(planned, 0.0) <= 2.0 + 0.05);
}

TEST(ContourPocket, CutsValleysThatRoughingDoesNotReachInLayers)
{
    Operation operation = pocket();
    Surface left = plane(60.0, -4.0);
    Surface right = left;
    left.points = {{0.0, 0.0, -4.0}, {0.0, 60.0, -4.0}, {30.0, 0.0, -16.0}, {30.0, 60.0, -16.0}};
    right.points = {{30.0, 0.0, -16.0}, {30.0, 60.0, -16.0}, {60.0, 0.0, -4.0}, {60.0, 60.0, -4.0}};
    operation.part.floor = {left, right};
    operation.levels.max_depth = 2.0;
    operation.passes.allowance = 0.2;
    operation.tool = {1, ToolShape::kBall, 1.5, 1.5};
    operation.tools = {{2, ToolShape::kFlat, 10.0, 0.0}, operation.tool};
    CHECK(deepest_first_cut(plan_contour_pocket(job(), operation), 0.0) <= 2.0 + 0.4);
}

// Roughing loops leave terraces on a slope, each as high as the slope climbs between two loops.
TEST(ContourPocket, CutsTheTerracesThatRoughingLeavesInLayers)
{
    Operation operation = pocket();
    operation.part.floor = {plane(60.0, -24.0)};
    for (Vec3d& p : operation.part.floor.front().points) {
        p.z += 0.9 * (p.x - 30.0);
    }
    operation.tool = {1, ToolShape::kFlat, 4.0, 0.0};
    operation.tolerance.plan = operation.tolerance.floor = 0.05;
    operation.tolerance.scallop = 0.6;
    operation.levels.max_depth = 2.0;
    operation.passes.allowance = 0.3;
    Job stock = job();
    stock.stock_top = 4.0;
    const auto plan = plan_contour_pocket(stock, operation);
    LONGS_EQUAL(2, plan.size());
    for (const auto& [key, value] : plan.back().stats.counts) {
        CHECK(key != "deepest_cut_mm" || value <= 2.02);
    }
    for (const std::string& warning : plan.back().stats.warnings) {
        CHECK(warning.find("max_depth") == std::string::npos);
    }
}

TEST(ContourPocket, LayersAreNoThinnerThanMinDepthAsFarAsMaxDepthLets)
{
    Operation operation = pocket();
    operation.tool = {1, ToolShape::kFlat, 4.0, 0.0};
    operation.levels.max_depth = 3.0;
    operation.levels.min_depth = 2.5;
    auto plan = plan_contour_pocket(job(), operation);
    const auto layers = [](const PlannedOperation& planned) {
        return planned.stats.counts.front().second;
    };
    // Three layers of 2.7 mm.
    DOUBLES_EQUAL(3.0, layers(plan.front()), 0.0);
    LONGS_EQUAL(0, plan.front().stats.warnings.size());
    operation.levels.min_depth = 2.9;
    plan = plan_contour_pocket(job(), operation);
    LONGS_EQUAL(1, plan.front().stats.warnings.size());
    STRCMP_CONTAINS("less than min_depth, 2.9 mm", plan.front().stats.warnings.front().c_str());
}

TEST(ContourPocket, SaysWhereTheToolDoesNotReachAndHowMuchStays)
{
    const PlannedOperation planned = plan_contour_pocket(job(), pocket()).back();
    // Four square corners less a quarter of a disc each, 8 mm high; the grid is 1 mm.
    const double volume = 4.0 * (1.0 - 0.785398) * 16.0 * 8.0;
    LONGS_EQUAL(4, static_cast<int>(count_of(planned, "rest_places")));
    DOUBLES_EQUAL(volume, count_of(planned, "rest_volume_mm3"), 0.3 * volume);
    DOUBLES_EQUAL(8.0, count_of(planned, "rest_height_max_mm"), 0.05);
    LONGS_EQUAL(4, planned.stats.warnings.size());
    CHECK(says(planned.stats.warnings.front(), "does not reach between walls at"));
}

TEST(ContourPocket, SaysWhichValleyItDoesNotReach)
{
    // A groove between two planes that a ball of 4 mm rolls over.
    Operation operation = pocket();
    Surface left = plane(60.0, 0.0);
    left.points = {{0.0, 0.0, -4.0}, {0.0, 60.0, -4.0}, {60.0, 0.0, -52.0}, {60.0, 60.0, -52.0}};
    Surface right = left;
    right.points = {{0.0, 0.0, -52.0}, {0.0, 60.0, -52.0}, {60.0, 0.0, -4.0}, {60.0, 60.0, -4.0}};
    operation.part.floor = {left, right};
    operation.tolerance.scallop = 0.1;
    const PlannedOperation planned = plan_contour_pocket(job(), operation).back();
    CHECK(std::any_of(planned.stats.warnings.begin(), planned.stats.warnings.end(),
                      [](const std::string& text) { return says(text, "a valley at ("); }));
    DOUBLES_EQUAL(0.0, planned.stats.gouge_bound_mm, 1e-9);
}

TEST(ContourPocket, RefusesWhatIsMissing)
{
    CHECK(says(refusal([](Operation& o) { o.part.floor.clear(); }), "floor is missing"));
    CHECK(says(refusal([](Operation& o) { o.outline.boundary.reset(); }), "boundary is missing"));
    CHECK(says(refusal([](Operation& o) { o.tolerance.scallop.reset(); }), "scallop is missing"));
}

TEST(ContourPocket, RefusesTolerancesOutOfRange)
{
    CHECK(says(refusal([](Operation& o) { o.tolerance.plan = 0.0; }), "plan_tolerance 0 mm"));
    CHECK(says(refusal([](Operation& o) { o.tolerance.floor = -1.0; }), "floor_tolerance -1 mm"));
    CHECK(says(refusal([](Operation& o) { o.tolerance.scallop = 5.0; }), "scallop 5 mm"));
    CHECK(says(
        refusal([](Operation& o) { o.tolerance.plan = 1.5; }),
        "job.toml: operation 1: contour_pocket: plan_tolerance 1.5 mm is not in the range above 0 "
        "to 1 mm, 0.25 of the radius of tool 1"));
    CHECK(says(refusal([](Operation& o) { o.tolerance.floor = 3.0; }),
               "floor_tolerance 3 mm is not in the range above 0 to 1 mm"));
    CHECK(says(refusal([](Operation& o) { o.passes.allowance = 4.5; }), "allowance 4.5 mm"));
    CHECK(says(refusal([](Operation& o) { o.tolerance.scallop = 0.02; }),
               "not above floor_tolerance"));
}

TEST(ContourPocket, RefusesWhatMakesNoSenseForTheTool)
{
    CHECK(says(refusal([](Operation& o) { o.part.floor = {plane(60.0, -4001.0)}; }),
               "floor.json: the floor lies 4001 mm below stock.top, the limit is 4000 mm for the "
               "tool of radius 4 mm"));
    CHECK(says(refusal([](Operation& o) {
                   o.outline.boundary = square_loop(5e4, 5e4, 4e4);
                   o.part.floor = {plane(1e5, -8.0)};
               }),
               "boundary.json: the pocket of 6.4e+09 mm^2 takes"));
    CHECK(says(refusal([](Operation& o) { o.levels.max_depth = 1e-3; }),
               "operation 1: contour_pocket: max_depth 0.001 mm makes"));
    CHECK(says(refusal([](Operation& o) { o.levels.max_depth = 1e-9; }),
               "layers of 8 mm, the limit is"));
}

TEST(ContourPocket, EntersByAHelixWhereTheInnermostLoopIsTooShortForARamp)
{
    for (int i = 0; i < 60; ++i) {
        Operation operation = pocket();
        operation.outline.boundary = square_loop(30.0, 30.0, 12.0 + 0.1 * i);
        operation.tool = {1, ToolShape::kFlat, 4.0, 0.0};
        operation.passes.entry = EntryKind::kRamp;
        const OperationStats stats = plan_contour_pocket(job(), operation).back().stats;
        for (const std::string& text : stats.warnings) {
            CHECK(!says(text, "no room for a slope"));
        }
    }
}

TEST(ContourPocket, EntersByASmallHelixWhereThereIsNoRoomForAWideOne)
{
    for (int i = 0; i < 60; ++i) {
        Operation operation = pocket();
        operation.outline.boundary = square_loop(30.0, 30.0, 4.4 + 0.005 * i);
        operation.tolerance.plan = operation.tolerance.floor = 0.001;
        operation.tolerance.scallop = 0.004;
        const OperationStats stats = plan_contour_pocket(job(), operation).back().stats;
        for (const std::string& text : stats.warnings) {
            CHECK(!says(text, "no room for a slope"));
        }
    }
}

TEST(ContourPocket, WarnsOfARoughingToolThatFitsNowhere)
{
    Operation operation = pocket();
    operation.levels.max_depth = 3.0;
    operation.tools = {{2, ToolShape::kFlat, 30.0, 0.0}, operation.tool};
    const std::vector<PlannedOperation> planned = plan_contour_pocket(job(), operation);
    LONGS_EQUAL(1, planned.size());
    CHECK(says(planned.back().stats.warnings.back(), "tool 2 of radius 30 mm fits nowhere"));
}

TEST(ContourPocket, OnlyFinishesWhatIsNoHigherThanTheAllowance)
{
    Operation operation = pocket();
    operation.part.floor = {plane(60.0, -0.2)};
    operation.levels.max_depth = 3.0;
    operation.passes.allowance = 0.3;
    const std::vector<PlannedOperation> planned = plan_contour_pocket(job(), operation);
    LONGS_EQUAL(1, planned.size());
    CHECK(says(planned.back().stats.warnings.back(), "no higher than the allowance, 0.3 mm"));
}

TEST(ContourPocket, WarnsThatItCutsAir)
{
    Operation operation = pocket();
    operation.part.floor = {plane(60.0, 8.0)};
    const auto warnings = plan_contour_pocket(job(), operation).back().stats.warnings;
    CHECK(!warnings.empty() && says(warnings.front(), "lies below stock.top, 0 mm"));
}

TEST(ContourPocket, RefusesLoopsThatCross)
{
    const auto island = [](double x, double half) {
        return [=](Operation& o) {
            o.outline.islands = {square_loop(x, 30.0, half)};
            o.outline.island_files = {"island.json"};
        };
    };
    CHECK(says(refusal(island(52.0, 6.0)), "boundary.json: crosses island.json"));
    CHECK(says(refusal(island(90.0, 6.0)), "island.json: the island lies outside"));
    CHECK(says(refusal([](Operation& o) {
                   const Vec2d p[] = {{5, 5}, {55, 55}, {55, 5}, {5, 55}};
                   o.outline.boundary = Loop{line_curve(p[0], p[1]), line_curve(p[1], p[2]),
                                             line_curve(p[2], p[3]), line_curve(p[3], p[0])};
               }),
               "crosses itself"));
}

TEST(ContourPocket, RefusesAToolThatFitsNowhere)
{
    CHECK(says(refusal([](Operation& o) {
                   o.tool = {1, ToolShape::kBall, 30.0, 30.0};
               }),
               "fits nowhere"));
}

TEST(ContourPocket, RefusesAFloorThatDoesNotCoverThePocket)
{
    CHECK(says(refusal([](Operation& o) { o.part.floor = {plane(40.0, -8.0)}; }),
               "floor.json: the floor does not cover the pocket at"));
}

// The plane over the pocket, trimmed to x in [from, to].
Surface strip(double z, double from, double to)
{
    Surface s = plane(60.0, z);
    const Vec2d p[] = {{from / 60.0, 0.0}, {to / 60.0, 0.0}, {to / 60.0, 1.0}, {from / 60.0, 1.0}};
    s.trims = {{line_curve(p[0], p[1]), line_curve(p[1], p[2]), line_curve(p[2], p[3]),
                line_curve(p[3], p[0])}};
    return s;
}

TEST(ContourPocket, CutsToTheHigherOfTrimmedFacesOnlyWhereItIs)
{
    Operation operation = pocket();
    operation.part.floor = {strip(-8.0, 0.0, 40.0), strip(-6.0, 40.0, 60.0)};
    const PlannedOperation planned = plan_contour_pocket(job(), operation).back();
    DOUBLES_EQUAL(0.0, planned.stats.gouge_bound_mm, 1e-9);
    double left = 1e300;
    double right = 1e300;
    for (const ToolMove& move : planned.path.moves) {
        if (const auto* line = std::get_if<LineTo>(&move.shape)) {
            double& lowest = line->end.x < 35.9 ? left : right;
            lowest =
                line->end.x < 35.9 || line->end.x > 40.0 ? std::min(lowest, line->end.z) : lowest;
        }
    }
    CHECK(left >= -8.0 && left <= -7.98);
    CHECK(right >= -6.0 && right <= -5.98);
}

TEST(ContourPocket, RefusesAGapBetweenTrimmedFaces)
{
    const std::string text = refusal([](Operation& operation) {
        operation.part.floor = {strip(-8.0, 0.0, 38.0), strip(-6.0, 40.0, 60.0)};
    });
    CHECK(says(text, "floor.json"));
    CHECK(says(text, "does not cover the pocket"));
}

TEST(ContourPocket, RefusesAHoleInATrimmedFloor)
{
    const std::string text = refusal([](Operation& operation) {
        Surface& floor = operation.part.floor.front();
        floor = strip(-8.0, 0.0, 60.0);
        const Loop hole = square_loop(0.5, 0.6, 0.04);
        floor.trims.push_back({hole[3], hole[2], hole[1], hole[0]});
        for (Curve& curve : floor.trims.back()) {
            std::swap(curve.points[0], curve.points[1]);
        }
    });
    CHECK(says(text, "does not cover the pocket"));
}

}  // namespace
}  // namespace cusp::test
