// Stock left beside a wall, between two passes and alone on a floor.
#include "host_tools/judge/verify/stock_distance.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::verify;

namespace {

// A floor at z 0, and a wall 7 mm high from x = 5 on.
struct FloorAtWall {
    HeightGrid grid{0, 0, 0.1, 101, 41};
    std::vector<double> heights;

    FloorAtWall()
    {
        for (std::size_t k = 0; k < grid.size(); ++k) {
            heights.push_back(grid.x(k / grid.ny, k % grid.ny) >= 5 ? 7.0 : 0.0);
        }
    }
    double at(std::size_t i, double top) const
    {
        return stock_distance(grid, heights, grid.index(i, 20), top, top, 0);
    }
};

}  // namespace

TEST_GROUP(StockDistance){};

TEST(StockDistance, OfASliverIsItsThickness)
{
    const FloorAtWall floor;
    for (const std::size_t i : {48U, 45U, 40U, 30U}) {
        const double thick = 5 - floor.grid.x(i, 20);
        const double found = floor.at(i, 7);
        CHECK(found >= thick);
        CHECK(found <= std::hypot(thick + floor.grid.pitch, floor.grid.pitch));
    }
}

TEST(StockDistance, OfACrestIsItsHeight)
{
    const FloorAtWall floor;
    DOUBLES_EQUAL(0.764, floor.at(20, 0.764), 1e-12);
}

TEST(StockDistance, OfAPillarIsItsHeight)
{
    const FloorAtWall floor;
    DOUBLES_EQUAL(2.9, floor.at(5, 2.9), 1e-12);
}

TEST(StockDistance, IsZeroWhereNothingIsLeft)
{
    const FloorAtWall floor;
    DOUBLES_EQUAL(0, floor.at(20, 0), 0);
}

TEST(StockDistance, CountsNoColumnWithoutMaterial)
{
    FloorAtWall floor;
    floor.heights.assign(floor.grid.size(), INFINITY);
    DOUBLES_EQUAL(6, floor.at(48, 6), 0);
}
