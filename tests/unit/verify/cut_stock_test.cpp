// Walls between two cuts, of any thickness and direction.
#include "host_tools/judge/verify/cut_stock.hpp"

#include <cmath>
#include <random>

#include "host_tools/base/elementary/elementary.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace verify;

namespace {

toolpath::Tool mill(double radius)
{
    toolpath::Tool tool;
    tool.radius = radius;
    return tool;
}

job::Job stock_of(double half)
{
    job::Job job;
    job.stock_top = 0;
    job.stock_x = {-half, half};
    job.stock_y = {-half, half};
    return job;
}

// A wall along a line through the origin; a tool whose edge reaches `into` it stands beside, at z = -2.
struct Wall {
    double thick;
    double angle;

    Vec3d place(double along, double across, double z) const
    {
        const double c = elementary::cos(angle);
        const double s = elementary::sin(angle);
        return {along * c - across * s, along * s + across * c, z};
    }

    std::optional<StandingPlace> under(double radius, double into, double along) const
    {
        const job::Job job = stock_of(50);
        const toolpath::Tool wide = mill(6);
        const toolpath::Tool tool = mill(radius);
        const Vec3d tip = place(along, radius + thick / 2 - into, -2);
        const ToolWay way = CutStock::way_of(tool, tip, tip);
        CutStock stock{job, {-50, 50, -50, 50, 0, 0}, {way}};
        for (const double side : {-1.0, 1.0}) {
            const double across = side * (thick / 2 + wide.radius);
            stock.cut(wide, place(-30, across, -3), place(30, across, -3));
        }
        return stock.under(way, stock.cuts());
    }
};

TEST_GROUP(CutStock){};

TEST(CutStock, WallsAreFoundWhereTheToolReachesThem)
{
    std::mt19937 random{7};
    std::uniform_real_distribution<double> share{0, 1};
    for (int k = 0; k < 400; ++k) {
        const Wall wall{0.02 + 0.28 * share(random), 3.2 * share(random)};
        const double radius = 0.5 + 4 * share(random);
        const double along = 4 * share(random);
        const auto found = wall.under(radius, 0.03 + 0.3 * share(random), along);
        CHECK(found.has_value());
        DOUBLES_EQUAL(2, found->depth, 1e-9);
        CHECK(!wall.under(radius, -0.01, along));
    }
}

TEST(CutStock, SliversAreNoWalls)
{
    for (const double angle : {0.0, 0.4, 0.785, 1.5}) {
        CHECK(!Wall({0.0145, angle}).under(2, 1, 0).has_value());
        CHECK(Wall({0.0175, angle}).under(2, 1, 0).has_value());
    }
}

TEST(CutStock, ALevelMoveMeetsAWallOnItsWay)
{
    const job::Job job = stock_of(50);
    const toolpath::Tool tool = mill(2);
    const ToolWay to_it = CutStock::way_of(tool, {-10, 0, -0.5}, {-2.1, 0, -0.5});
    const ToolWay through = CutStock::way_of(tool, {-10, 0, -0.5}, {10, 0, -0.5});
    CutStock stock{job, {-50, 50, -50, 50, 0, 0}, {to_it, through}};
    stock.cut(tool, {-10, 0, -1}, {-2.05, 0, -1});
    stock.cut(tool, {2.05, 0, -1}, {10, 0, -1});
    const std::size_t with_wall = stock.cuts();
    stock.cut(tool, {-2.1, 0, -1}, {2.1, 0, -1});
    CHECK(!stock.under(to_it, with_wall));
    const auto found = stock.under(through, with_wall);
    CHECK(found.has_value());
    DOUBLES_EQUAL(0.5, found->depth, 1e-9);
    CHECK(!stock.under(through, stock.cuts()));
}

}  // namespace
}  // namespace cusp::test
