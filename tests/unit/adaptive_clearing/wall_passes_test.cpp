// Passes along a wall where stock is left beside it.
#include "host_tools/cam/adaptive_clearing/wall_passes.hpp"

#include "host_tools/cam/adaptive_clearing/swept_area.hpp"
#include "host_tools/cam/adaptive_clearing/wall_budget.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace adaptive_clearing;
using namespace offset;

namespace {

Contour box_from(double x0, double y0, double x1, double y1, double first_x)
{
    return {line_edge({first_x, y0}, {x1, y0}), line_edge({x1, y0}, {x1, y1}),
            line_edge({x1, y1}, {x0, y1}), line_edge({x0, y1}, {x0, y0}),
            line_edge({x0, y0}, {first_x, y0})};
}

TEST_GROUP(WallPasses){};

// 1 mm of stock is left from x = 15 to 25 along a wall that is clear elsewhere.
TEST(WallPasses, StockAboutTheBeginningOfAContourIsOnePass)
{
    SweptArea swept{{0, 0, 60, 40}, 3.0};
    swept.add(line_edge({3, 4}, {57, 4}));
    swept.add(line_edge({3, 3}, {15, 3}));
    swept.add(line_edge({25, 3}, {57, 3}));
    swept.add(line_edge({57, 3}, {57, 37}));
    swept.add(line_edge({57, 37}, {3, 37}));
    swept.add(line_edge({3, 37}, {3, 3}));
    const RegionOffset walls{Region2d{{box_from(0, 0, 60, 40, 30)}}};
    for (const double first_x : {15.5, 20.0, 30.0}) {
        const WallPasses passes = uncut_stretches(
            box_from(3, 3, 57, 37, first_x), {swept, walls, 3.0, 0.01, 1.0, 0.001, {0, 0, 60, 40}});
        LONGS_EQUAL(1, passes.paths.size());
        CHECK(!passes.left);
        CHECK(passes.paths.front().front().start.x < 15.5);
        CHECK(passes.paths.front().back().end.x > 24.5);
    }
}

// A path beside the wall leaves a strip of this thickness, mm.
bool is_looked_for(double thickness, double sliver, double radius)
{
    const double size = 20 * radius;
    SweptArea swept{{0, 0, size, size}, radius};
    const double from = radius + thickness;
    swept.add(line_edge({from, from}, {size - from, from}));
    swept.add(line_edge({size - from, from}, {size - from, size - from}));
    swept.add(line_edge({size - from, size - from}, {from, size - from}));
    swept.add(line_edge({from, size - from}, {from, from}));
    const RegionOffset walls{Region2d{{box_from(0, 0, size, size, size / 2)}}};
    return !uncut_stretches(box_from(radius, radius, size - radius, size - radius, size / 2),
                            {swept, walls, radius, sliver, 1.0, 0.001, {0, 0, size, size}})
                .paths.empty();
}

TEST(WallPasses, NoMoreStaysBesideAWallThanThereIsRoomFor)
{
    for (const double radius : {0.5, 2.5, 8.0, 14.0}) {
        for (const double share : {0.0007, 0.001, 0.003, 0.0072, 0.03}) {
            const double room = share * radius;
            const WallShares shares = shares_of(room, radius);
            CHECK(shares.chords > 0 && shares.chords <= 0.005 * radius);
            CHECK(room_for(shares.chords, radius) <= room + 1e-12);
            CHECK(is_looked_for(1.001 * room, shares.sliver, radius));
            CHECK(!is_looked_for(0.9 * shares.sliver, shares.sliver, radius));
        }
    }
}

TEST(WallPasses, ChordsThatCountTwiceAreWithinTheRoomToo)
{
    for (const double radius : {0.5, 2.5, 8.0, 14.0}) {
        for (const double share : {0.001, 0.003, 0.0072, 0.03}) {
            const double room = share * radius;
            const auto [chords, sliver] = shares_of(room, radius, true);
            CHECK(chords > 0 && missed_beside(chords, radius) <= sliver + 1e-12);
            CHECK(is_looked_for(1.001 * (room - chords), sliver, radius));
        }
    }
    CHECK(shares_of(0.005, 11.0).chords < 0);
}

}  // namespace
}  // namespace cusp::test
