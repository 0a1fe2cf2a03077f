// The points of a grid that have stock before any cut.
#include "host_tools/judge/verify/uncut_stock.hpp"

#include <algorithm>
#include <cmath>

#include "CppUTest/TestHarness.h"

#include "host_tools/judge/verify/stock_grid.hpp"

using namespace cusp;
using namespace cusp::verify;

namespace {

job::Loop square(double half)
{
    const Vec3d corners[]{
        {-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}, {-half, -half, 0}};
    job::Loop loop;
    for (std::size_t i = 0; i < 4; ++i) {
        loop.push_back({1, {0, 0, 1, 1}, {corners[i], corners[i + 1]}, {1, 1}});
    }
    return loop;
}

}  // namespace

TEST_GROUP(UncutStock)
{
    job::Job job;
    HeightGrid grid{-10, -10, 0.25, 80, 80};

    void setup() override { job.stock_top = 3; }
};

TEST(UncutStock, fills_the_grid_without_an_outline)
{
    const MachinedStock stock = UncutStock{job}.on(grid);
    for (const double height : stock.heights()) {
        DOUBLES_EQUAL(3, height, 0);
    }
}

TEST(UncutStock, lies_in_its_outline_and_not_in_its_holes)
{
    job.stock_outline = {square(8), square(2)};
    const MachinedStock stock = UncutStock{job}.on(grid);
    for (std::size_t i = 0; i < grid.nx; ++i) {
        for (std::size_t j = 0; j < grid.ny; ++j) {
            const double away = std::max(std::abs(grid.x(i, j)), std::abs(grid.y(i, j)));
            const double height = stock.heights()[grid.index(i, j)];
            DOUBLES_EQUAL(away < 8 && away > 2 ? 3 : -kUnbounded, height, 0);
        }
    }
    DOUBLES_EQUAL(0, stock.removed_volume(), 0);
}

// A tool beside the stock cuts nothing, and no more than is there at its edge.
TEST(UncutStock, is_all_that_a_tool_removes)
{
    job.stock_outline = {square(8)};
    MachinedStock stock = UncutStock{job}.on(grid);
    ToolPositions run;
    run.tool = {1, toolpath::ToolShape::kFlat, 1, 0};
    const auto cut = [&](Vec3d tip) {
        run.tips = {tip};
        run.rapid = {false};
        return stock.cut(run, 0.1, [](double) {});
    };
    DOUBLES_EQUAL(0, cut({9.3, 0, 0}), 0);
    DOUBLES_EQUAL(0, stock.removed_volume(), 0);
    CHECK(cut({8, 0, 0}) > 2.9);
    DOUBLES_EQUAL(3 * 3.14159 / 2, stock.removed_volume(), 0.4);
}
