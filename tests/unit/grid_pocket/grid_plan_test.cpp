// Whole plans on the paper's pockets and on random ones, judged by exact clearances.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/grid_pocket/grid_pocket.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/support/loops.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/tap.hpp"
#include "tests/support/test_jobs.hpp"

using namespace cusp::grid_pocket;
using namespace cusp::job;
using namespace cusp::nurbs;
using namespace cusp::offset;
using namespace cusp::part_model;
using namespace cusp::test;
using namespace cusp::toolpath;
using cusp::Vec3d;

namespace {

Surface hills(double width, double depth, std::mt19937& random)
{
    std::uniform_real_distribution<double> height{-9, -3};
    const auto knots = clamped_uniform_knots(7, 3);
    std::vector<Vec3d> net;
    for (std::size_t i = 0; i < 7; ++i) {
        for (std::size_t j = 0; j < 7; ++j) {
            const auto greville = [&](std::size_t k) {
                return (knots[k + 1] + knots[k + 2] + knots[k + 3]) / 3;
            };
            net.push_back({width * greville(i), depth * greville(j), height(random)});
        }
    }
    return bicubic(7, 7, std::move(net));
}

Operation operation_of(unsigned seed, OutputForm output)
{
    std::mt19937 random{seed};
    Operation operation;
    operation.strategy = &cusp::grid_pocket::kGridPocket;
    operation.part.floor = {hills(40, 30, random)};
    operation.outline.boundary =
        loop_of({{1, 1}, {39, 2}, {36, 15}, {39, 29}, {20, 24}, {2, 28}, {5, 14}});
    operation.tool = {1, ToolShape::kBall, 3, 3};
    cusp::grid_pocket::grid_keys(operation).grid_x = 1.5;
    cusp::grid_pocket::grid_keys(operation).grid_y = 1.2;
    operation.output = output;
    operation.tolerance.floor = 0.02;
    operation.tolerance.plan = 0.02;
    cusp::grid_pocket::grid_keys(operation).arc_tolerance = 0.02;
    cusp::grid_pocket::grid_keys(operation).max_arc_radius = 500;
    return operation;
}

// Quick to try finer grids on.
const Loop kSmall = loop_of({{14, 11}, {24, 11}, {24, 20}, {14, 20}});

// Points along a move, its end included.
std::vector<Vec3d> along(const ToolMove& move, Vec3d from)
{
    std::vector<Vec3d> out;
    const std::vector<Vec3d> corners = points_of(move, from, 1e-6);
    const int pieces = 1 + 20 / static_cast<int>(corners.size());
    for (const Vec3d& corner : corners) {
        for (int i = 1; i <= pieces; ++i) {
            out.push_back(from + (corner - from) * (static_cast<double>(i) / pieces));
        }
        from = corner;
    }
    return out;
}

double least_clearance(const PlannedOperation& plan, const Operation& operation)
{
    const PartModel model{operation.part.floor};
    double least = 1e300;
    Vec3d at = end_of(plan.path.moves.front());
    for (const ToolMove& move : plan.path.moves) {
        for (const Vec3d& p : along(move, at)) {
            least = std::min(least, model.distance(operation.tool, p, 1).distance);
        }
        at = end_of(move);
    }
    return least;
}

std::string refusal(const Operation& operation)
{
    return cusp::test::refusal([&] { plan_grid_pocket(plain_job(), operation); });
}

}  // namespace

TEST_GROUP(GridPlan){};

TEST(GridPlan, NeverCutsIntoRandomFloors)
{
    for (unsigned seed = 1; seed <= 4; ++seed) {
        std::printf("GridPlan seed %u\n", seed);
        const OutputForm form = seed % 2 == 0 ? OutputForm::kArcs : OutputForm::kLines;
        const Operation operation = operation_of(seed, form);
        const auto plan = plan_grid_pocket(plain_job(), operation);
        CHECK(plan[0].stats.gouge_bound_mm <= 1e-6);
        CHECK(least_clearance(plan[0], operation) >= -2e-6);
    }
}

TEST(GridPlan, LayersAndZigzagsNeverCutInEither)
{
    Operation operation = operation_of(9, OutputForm::kArcs);
    operation.levels.max_depth = 3;
    operation.passes.allowance = 0.3;
    cusp::grid_pocket::grid_keys(operation).zigzag = {'x', 'y'};
    const auto plan = plan_grid_pocket(plain_job(), operation);
    CHECK(count_of(plan[0], "layers") >= 2);
    CHECK(least_clearance(plan[0], operation) >= -2e-6);
}

TEST(GridPlan, LayersOfBoundedEngagementNeverCutInNorDeeperThanAllowed)
{
    Operation operation = operation_of(9, OutputForm::kArcs);
    operation.levels.max_depth = 3;
    operation.passes.max_engagement = 60;
    operation.outline.boundary = loop_of({{10, 8}, {28, 8}, {30, 22}, {10, 20}});
    operation.outline.islands = {loop_of({{19, 13}, {20, 13}, {20, 14}, {19, 14}})};
    operation.outline.island_files = {"island"};
    for (const Tool& tool : {Tool{1, ToolShape::kBall, 3, 3}, Tool{1, ToolShape::kFlat, 3, 0},
                             Tool{1, ToolShape::kBull, 3, 1}}) {
        operation.tool = tool;
        const auto plan = plan_grid_pocket(plain_job(), operation);
        CHECK(count_of(plan[0], "layers") >= 2);
        CHECK(count_of(plan[0], "entries") >= 2);
        CHECK(count_of(plan[0], "engagement_bound_deg") > 30);
        CHECK(count_of(plan[0], "engagement_bound_deg") <= 60 + 1e-9);
        CHECK(count_of(plan[0], "deepest_cut_mm") <= 3);
        CHECK(least_clearance(plan[0], operation) >= -2e-6);
    }
}

TEST(GridPlan, TakesLayersOfBoundedEngagementAtTheDepthsOfTheJobAndAtTheFloor)
{
    Operation operation = operation_of(9, OutputForm::kLines);
    operation.tool = {1, ToolShape::kFlat, 3, 0};
    for (Vec3d& point : operation.part.floor.front().points) {
        point.z = -4;
    }
    operation.levels.layers = {1.5};
    operation.passes.max_engagement = 60;
    const auto plan = plan_grid_pocket(plain_job(), operation);
    LONGS_EQUAL(2, count_of(plan[0], "layers"));
    double least = 0;
    for (const ToolMove& move : plan[0].path.moves) {
        least = std::min(least, end_of(move).z);
    }
    DOUBLES_EQUAL(-4, least, 0.021);
}

TEST(GridPlan, TurnsAroundWallsInArcsWhereTheFloorIsLevel)
{
    Operation operation = operation_of(1, OutputForm::kArcs);
    for (Vec3d& point : operation.part.floor.front().points) {
        point.z = -4;
    }
    for (const Tool& tool : {Tool{1, ToolShape::kBall, 3, 3}, Tool{1, ToolShape::kFlat, 3, 0}}) {
        operation.tool = tool;
        const auto plan = plan_grid_pocket(plain_job(), operation);
        int turns = 0;
        for (const ToolMove& move : plan[0].path.moves) {
            const auto* arc = std::get_if<ArcTo>(&move.shape);
            turns += arc != nullptr && arc->plane == ArcPlane::kXY ? 1 : 0;
        }
        // The corners at (36, 15), (20, 24) and (5, 14).
        LONGS_EQUAL(3, turns);
        DOUBLES_EQUAL(0, plan[0].stats.gouge_bound_mm, 1e-6);
    }
}

TEST(GridPlan, ReportsHowDeepATwoSidedToleranceCutsIn)
{
    for (const OutputForm form : {OutputForm::kLines, OutputForm::kArcs}) {
        Operation operation = operation_of(6, form);
        operation.tolerance.side = ToleranceSide::kBoth;
        const auto plan = plan_grid_pocket(plain_job(), operation);
        CHECK(plan[0].stats.gouge_bound_mm <= 0.02 + 2e-6);
        CHECK(least_clearance(plan[0], operation) >= -plan[0].stats.gouge_bound_mm - 2e-6);
    }
}

TEST(GridPlan, LayersVisitOnlyCellsThatTheFloorLeaves)
{
    Operation operation = operation_of(9, OutputForm::kLines);
    operation.levels.layers = {2.0, 6.0, 7.0};
    const auto plan = plan_grid_pocket(plain_job(), operation);
    CHECK(count_of(plan[0], "steps") < 4 * count_of(plan[0], "cells"));
}

TEST(GridPlan, KeepsTheRadiusFromTheWalls)
{
    const Operation operation = operation_of(5, OutputForm::kLines);
    const auto plan = plan_grid_pocket(plain_job(), operation);
    Region2d region;
    Contour contour;
    for (const Curve& c : *operation.outline.boundary) {
        contour.push_back(
            line_edge({c.points[0].x, c.points[0].y}, {c.points[1].x, c.points[1].y}));
    }
    region.contours.push_back(contour);
    const RegionOffset walls{region};
    Vec3d at = end_of(plan[0].path.moves.front());
    for (const ToolMove& move : plan[0].path.moves) {
        for (const Vec3d& p : along(move, at)) {
            CHECK(walls.clearance({p.x, p.y}) >= 3 - 1e-4);
        }
        at = end_of(move);
    }
}

TEST(GridPlan, NamesAGridThatKeepsTheRoughness)
{
    Operation operation = operation_of(3, OutputForm::kLines);
    operation.outline.boundary = kSmall;
    cusp::grid_pocket::grid_keys(operation).max_roughness = 0.02;
    const std::string text = refusal(operation);
    CHECK(text.find("suffices") != std::string::npos);
    const std::size_t from = text.find("; grid ") + 7;
    cusp::grid_pocket::grid_keys(operation).grid_x = std::stod(text.substr(from));
    cusp::grid_pocket::grid_keys(operation).grid_y =
        std::stod(text.substr(text.find(" x ", from) + 3));
    STRCMP_EQUAL("", refusal(operation).c_str());
}

TEST(GridPlan, RefusesInputThatCannotBeUsedWithItsValueAndLimit)
{
    const double nothing = std::nan("");
    const auto says = [](const char* part, auto change) {
        Operation operation = operation_of(1, OutputForm::kLines);
        change(operation);
        STRCMP_CONTAINS(part, refusal(operation).c_str());
    };
    says("floor names no surface", [](Operation& o) { o.part.floor.clear(); });
    says("boundary is missing", [](Operation& o) { o.outline.boundary.reset(); });
    says("grid 0.00000 mm must be above 0",
         [](Operation& o) { cusp::grid_pocket::grid_keys(o).grid_x = 0; });
    says("grid nan", [&](Operation& o) { cusp::grid_pocket::grid_keys(o).grid_x = nothing; });
    says("grid inf mm is over the diameter / sqrt 2, 4.24264 mm",
         [](Operation& o) { cusp::grid_pocket::grid_keys(o).grid_x = HUGE_VAL; });
    says("grid 4.30000 mm is over the diameter / sqrt 2, 4.24264 mm",
         [](Operation& o) { cusp::grid_pocket::grid_keys(o).grid_y = 4.3; });
    says("cells; at most 4000000",
         [](Operation& o) { cusp::grid_pocket::grid_keys(o).grid_x = 1e-4; });
    says("tool 1 has radius 0.00000 mm", [](Operation& o) { o.tool.radius = 0; });
    says("no place in the pocket is 30.00000 mm from its walls", [](Operation& o) {
        o.tool = {1, ToolShape::kBall, 30, 30};
    });
    says("output \"nurbs\"", [](Operation& o) { o.output = OutputForm::kNurbs; });
    says("max_depth 0.00000 mm must be above 0", [](Operation& o) { o.levels.max_depth = 0.0; });
    says("max_depth 1e-06 mm makes more than 10000 layers",
         [](Operation& o) { o.levels.max_depth = 1e-6; });
    says("depth 2.00000 mm is not below the one before, 3.00000 mm", [](Operation& o) {
        o.levels.layers = {3, 2};
    });
    says("max_roughness 0.00000 mm must be above 0",
         [](Operation& o) { cusp::grid_pocket::grid_keys(o).max_roughness = 0.0; });
    says("over max_roughness 0.01000 mm; grid", [](Operation& o) {
        o.outline.boundary = kSmall;
        cusp::grid_pocket::grid_keys(o).max_roughness = 0.01;
    });
    says("tolerance or radius nan", [&](Operation& o) { o.tolerance.floor = nothing; });
    says("tolerance or radius -0.10000 mm", [](Operation& o) { o.passes.allowance = -0.1; });
    says("crosses itself at x 15.00000 mm, y 15.00000 mm", [](Operation& o) {
        o.outline.boundary = loop_of({{0, 0}, {30, 30}, {30, 0}, {0, 30}});
    });
    says("the floor does not cover the pocket at x 100.00000 mm", [](Operation& o) {
        o.outline.boundary = loop_of({{100, 0}, {130, 0}, {130, 30}});
    });
    says("the floor does not cover the pocket at x", [](Operation& o) {
        o.part.floor.front().trims = {loop_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}}),
                                      loop_of({{0.5, 0.4}, {0.4, 0.5}, {0.5, 0.6}, {0.6, 0.5}})};
    });
}
