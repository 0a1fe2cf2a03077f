// No cut is deeper than max_depth, beside cliffs and below them too; the stock height is known.
#include <utility>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/clearing/stock_height_map.hpp"
#include "host_tools/cam/grid_pocket/grid_pocket.hpp"
#include "tests/support/loops.hpp"
#include "tests/support/test_jobs.hpp"

using namespace cusp::clearing;
using namespace cusp::grid_pocket;
using namespace cusp::job;
using namespace cusp::nurbs;
using namespace cusp::offset;
using namespace cusp::test;
using namespace cusp::toolpath;
using cusp::Vec3d;

namespace {

constexpr Tool kBall{1, ToolShape::kBall, 3, 3};

Surface level(const Box2d& box, double z)
{
    Surface s;
    s.degree_u = s.degree_v = 1;
    s.size_u = s.size_v = 2;
    s.knots_u = s.knots_v = {0, 0, 1, 1};
    s.points = {{box.x0, box.y0, z}, {box.x0, box.y1, z}, {box.x1, box.y0, z}, {box.x1, box.y1, z}};
    s.weights.assign(4, 1.0);
    return s;
}

// A table with vertical sides, 7 mm above a level floor.
Operation beside_a_cliff()
{
    Operation operation;
    operation.part.floor = {level({-10, -10, 40, 40}, -9), level({11, 11, 19, 19}, -2)};
    operation.outline.boundary = loop_of({{0, 0}, {30, 0}, {30, 30}, {0, 30}});
    operation.tool = kBall;
    cusp::grid_pocket::grid_keys(operation).grid_x = 2;
    cusp::grid_pocket::grid_keys(operation).grid_y = 1.5;
    operation.tolerance.floor = operation.tolerance.plan = 0.02;
    operation.levels.max_depth = 1.5;
    return operation;
}

}  // namespace

TEST_GROUP(DepthLimiter){};

TEST(DepthLimiter, StockIsMetAtTheToolsLowerSide)
{
    StockHeightMap stock{{-10, -10, 10, 10}, kBall, 0};
    DOUBLES_EQUAL(0, stock.contact_height({0, 0}), 0.05);
    DOUBLES_EQUAL(2, stock.cut({-8, 0, -2}, {8, 0, -2}), 0.05);
    DOUBLES_EQUAL(-2, stock.contact_height({0, 0}), 0.05);
    // Beside the groove of the ball its rim still meets the stock's top.
    CHECK(stock.contact_height({0, 2}) > -0.5);
    DOUBLES_EQUAL(0, stock.cut({-8, 0, -2}, {8, 0, -2}), 1e-9);
    DOUBLES_EQUAL(1, stock.cut({-8, 0, -3}, {8, 0, -3}), 0.05);
}

TEST(DepthLimiter, HoldsBesideACliffWithAnAllowance)
{
    Operation operation = beside_a_cliff();
    operation.passes.allowance = 0.3;
    const auto plan = plan_grid_pocket(plain_job(), operation);
    CHECK(count_of(plan[0], "deepest_cut_mm") <= 1.5);
    CHECK(count_of(plan[0], "depth_passes") > 0);
    // Only from the stock left beside the table.
    LONGS_EQUAL(1, plan[0].stats.warnings.size());
    STRCMP_CONTAINS("the floor steps by ", plan[0].stats.warnings[0].c_str());
}

TEST(DepthLimiter, HoldsWhereTheFloorFallsByMoreThanALayerFromCellToCell)
{
    Operation operation = beside_a_cliff();
    cusp::grid_pocket::grid_keys(operation).grid_x =
        cusp::grid_pocket::grid_keys(operation).grid_y = 4.2;
    operation.levels.max_depth = 1.0;
    const auto plan = plan_grid_pocket(plain_job(), operation);
    CHECK(count_of(plan[0], "deepest_cut_mm") <= 1.0);
}

TEST(DepthLimiter, IsNoneForLayersOfTheJobButTheDepthIsReported)
{
    Operation operation = beside_a_cliff();
    operation.levels.max_depth.reset();
    operation.levels.layers = {4};
    const auto plan = plan_grid_pocket(plain_job(), operation);
    DOUBLES_EQUAL(5, count_of(plan[0], "deepest_cut_mm"), 0.1);
}

TEST(DepthLimiter, LayersThatTheFloorKeepsTheToolFromAreNamed)
{
    Operation operation = beside_a_cliff();
    operation.levels.max_depth.reset();
    operation.levels.layers = {4, 9.5, 12};
    const auto plan = plan_grid_pocket(plain_job(), operation);
    LONGS_EQUAL(1, static_cast<int>(count_of(plan[0], "layers")));
    LONGS_EQUAL(2, plan[0].stats.warnings.size());
    STRCMP_CONTAINS("layers: 2 lie below 9.00000 mm under stock.top",
                    plan[0].stats.warnings[0].c_str());
}
