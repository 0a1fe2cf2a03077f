#include "host_tools/geometry/offset/offset.hpp"

#include "CppUTest/TestHarness.h"

#include "tests/unit/offset/polygons.hpp"

namespace cusp::test {

using namespace offset;

namespace {

double total_area(const Region2d& region)
{
    double sum = 0.0;
    for (const Contour& contour : region.contours) {
        sum += area(contour);
    }
    return sum;
}

constexpr double kPi = 3.14159265358979323846;

TEST_GROUP(Offset){};

TEST(Offset, ShrinksASquareExactly)
{
    const Region2d result = RegionOffset{{{rectangle(0, 0, 20, 20)}}}.at(3.0);
    LONGS_EQUAL(1, result.contours.size());
    LONGS_EQUAL(4, result.contours[0].size());
    DOUBLES_EQUAL(14.0 * 14.0, total_area(result), 1e-9);
}

TEST(Offset, LeavesNothingWhereTheToolIsTooLarge)
{
    CHECK(RegionOffset({{rectangle(0, 0, 20, 20)}}).at(10.0).contours.empty());
    CHECK(RegionOffset({{rectangle(0, 0, 20, 20)}}).at(11.0).contours.empty());
}

TEST(Offset, RoundsTheCornersOfAnIslandWithTrueArcs)
{
    const Region2d source{{square(0, 0, 50), reversed(square(0, 0, 5))}};
    const Region2d result = RegionOffset{source}.at(4.0);
    LONGS_EQUAL(2, result.contours.size());
    DOUBLES_EQUAL(92.0 * 92.0 - (100.0 + 4 * 40.0 + kPi * 16.0), total_area(result), 1e-9);
}

TEST(Offset, MergesAnIslandWithTheBoundaryItComesNear)
{
    const Region2d source{{rectangle(0, 0, 40, 40), reversed(rectangle(3, 15, 13, 25))}};
    LONGS_EQUAL(2, RegionOffset{source}.at(1.0).contours.size());
    LONGS_EQUAL(1, RegionOffset{source}.at(2.0).contours.size());
}

TEST(Offset, MergesTwoIslands)
{
    const Region2d source{{rectangle(0, 0, 60, 40), reversed(rectangle(20, 15, 28, 25)),
                           reversed(rectangle(31, 15, 39, 25))}};
    LONGS_EQUAL(3, RegionOffset{source}.at(1.4).contours.size());
    LONGS_EQUAL(2, RegionOffset{source}.at(1.6).contours.size());
}

TEST(Offset, TakesIslandsWithACommonEdgeAsOne)
{
    const Region2d source{{rectangle(0, 0, 60, 40), reversed(rectangle(20, 15, 30, 25)),
                           reversed(rectangle(30, 15, 40, 25))}};
    const Region2d result = RegionOffset{source}.at(2.0);
    LONGS_EQUAL(2, result.contours.size());
    DOUBLES_EQUAL(56.0 * 36.0 - (200.0 + 2 * 60.0 + kPi * 4.0), total_area(result), 1e-6);
}

TEST(Offset, SplitsAtANeck)
{
    const Region2d source{{polygon({{0, 0},
                                    {20, 0},
                                    {20, 8},
                                    {30, 8},
                                    {30, 0},
                                    {50, 0},
                                    {50, 20},
                                    {30, 20},
                                    {30, 12},
                                    {20, 12},
                                    {20, 20},
                                    {0, 20}})}};
    LONGS_EQUAL(1, RegionOffset{source}.at(1.9).contours.size());
    LONGS_EQUAL(2, RegionOffset{source}.at(2.1).contours.size());
}

TEST(Offset, SurvivesAFilletOfExactlyItsDistance)
{
    // A square with corners rounded by 3, offset by 3: the arcs shrink to points.
    Contour contour;
    const Vec2d corners[] = {{0, 0}, {20, 0}, {20, 20}, {0, 20}};
    const Vec2d ways[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2d next = corners[(i + 1) % 4];
        const Vec2d way = ways[i];
        const Vec2d turned = ways[(i + 1) % 4];
        contour.push_back(line_edge(corners[i] + way * 3.0, next - way * 3.0));
        contour.push_back(
            arc_edge(next - way * 3.0, next + turned * 3.0, next - way * 3.0 + turned * 3.0, 1));
    }
    const Region2d result = RegionOffset{{{contour}}}.at(3.0);
    DOUBLES_EQUAL(14.0 * 14.0, total_area(result), 1e-6);
}

TEST(Offset, GrowsARegionWithRoundedCorners)
{
    const Region2d result = grown({{rectangle(0, 0, 10, 10)}}, 2.0);
    DOUBLES_EQUAL(100.0 + 4 * 20.0 + kPi * 4.0, total_area(result), 1e-9);
}

// An arc that by rounding had a direction but no length turned points far from it inside out.
TEST(Offset, AnArcWithoutLengthChangesNoPointsSide)
{
    Contour square = rectangle(0, 0, 20, 20);
    const Vec2d a{10.0, 20.0};
    const Vec2d b{10.0, 20.0 - 7e-15};
    const Edge top = square[2];
    square[2] = line_edge(top.start, a);
    square.insert(square.begin() + 3, {arc_edge(a, b, {10.0, 15.0}, -1), line_edge(b, top.end)});
    CHECK(surrounds(square, {14.0, 16.0}));
    CHECK(surrounds(square, {6.0, 16.0}));
    CHECK_FALSE(surrounds(square, {14.0, 21.0}));
    square[3] = arc_edge(a, b, {10.0, 25.0}, 1);
    CHECK_FALSE(surrounds(square, {14.0, 24.0}));
    CHECK_FALSE(surrounds(square, {6.0, 24.0}));
}

TEST(Offset, TellsTheClearanceOfAPoint)
{
    const RegionOffset offset{{{rectangle(0, 0, 20, 20)}}};
    DOUBLES_EQUAL(4.0, offset.clearance({4.0, 10.0}), 1e-12);
    DOUBLES_EQUAL(-1.0, offset.clearance({-1.0, 10.0}), 1e-12);
}

}  // namespace
}  // namespace cusp::test
