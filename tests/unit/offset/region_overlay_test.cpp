#include "host_tools/geometry/offset/region_overlay.hpp"

#include "CppUTest/TestHarness.h"

#include "host_tools/geometry/offset/region_check.hpp"
#include "tests/unit/offset/polygons.hpp"

namespace cusp::test {

using namespace offset;

namespace {

TEST_GROUP(RegionOverlay){};

TEST(RegionOverlay, OfTwoSquaresThatCross)
{
    const Region2d a{{square(0, 0, 10)}};
    const Region2d b{{square(12, 5, 10)}};
    const double both = 8 * 15;
    DOUBLES_EQUAL(both, area(common(a, b)), 1e-9);
    DOUBLES_EQUAL(800 - both, area(united(a, b)), 1e-9);
    DOUBLES_EQUAL(400 - both, area(without(a, b)), 1e-9);
}

TEST(RegionOverlay, OfRegionsWhoseContoursDoNotMeet)
{
    const Region2d a{{square(0, 0, 10)}};
    const Region2d inside{{square(1, 1, 3)}};
    const Region2d apart{{square(40, 0, 5)}};
    LONGS_EQUAL(2, without(a, inside).contours.size());
    LONGS_EQUAL(1, united(a, inside).contours.size());
    LONGS_EQUAL(2, united(a, apart).contours.size());
    LONGS_EQUAL(0, common(a, apart).contours.size());
    LONGS_EQUAL(0, without(inside, a).contours.size());
}

TEST(RegionOverlay, OfEqualRegionsIsTheRegionOrNothing)
{
    const Region2d ring{{square(0, 0, 10), reversed(square(0, 0, 3))}};
    DOUBLES_EQUAL(364, area(common(ring, ring)), 1e-9);
    DOUBLES_EQUAL(364, area(united(ring, ring)), 1e-9);
    LONGS_EQUAL(0, without(ring, ring).contours.size());
}

TEST(RegionOverlay, JoinsRegionsThatShareAnEdge)
{
    const Region2d a{{rectangle(0, 0, 10, 10)}};
    const Region2d b{{rectangle(10, 2, 15, 8)}};
    LONGS_EQUAL(1, united(a, b).contours.size());
    DOUBLES_EQUAL(130, area(united(a, b)), 1e-9);
    LONGS_EQUAL(0, common(a, b).contours.size());
    DOUBLES_EQUAL(100, area(without(a, b)), 1e-9);
}

TEST(RegionOverlay, KeepsContoursApartThatTouchAtACorner)
{
    const Region2d a{{rectangle(0, 0, 10, 10)}};
    const Region2d b{{rectangle(10, 10, 20, 20)}};
    LONGS_EQUAL(2, united(a, b).contours.size());
    LONGS_EQUAL(0, common(a, b).contours.size());
}

TEST(RegionOverlay, LeavesHolesThatTouchAtACornerTwoLoops)
{
    const Region2d plate{{rectangle(-5, -5, 25, 25)}};
    const Region2d holes{{rectangle(0, 0, 10, 10), rectangle(10, 10, 20, 20)}};
    const Region2d left = without(plate, holes);
    LONGS_EQUAL(3, left.contours.size());
    CHECK(!find_fault({{left.contours[0], left.contours[1], left.contours[2]}}));
}

TEST(RegionOverlay, CutsArcsAndHoles)
{
    const Contour disc{
        arc_edge({10, 0}, {0, 10}, {0, 0}, 1), arc_edge({0, 10}, {-10, 0}, {0, 0}, 1),
        arc_edge({-10, 0}, {0, -10}, {0, 0}, 1), arc_edge({0, -10}, {10, 0}, {0, 0}, 1)};
    const Region2d ring{{disc, reversed(square(0, 0, 3))}};
    const Region2d half{{rectangle(-20, -20, 0.5, 20)}};
    const double whole = area(ring);
    const double left = area(common(ring, half));
    DOUBLES_EQUAL(whole, left + area(without(ring, half)), 1e-9);
    // Right of x = 0.5: the segment of the disc, less 2.5 x 6 of the hole.
    DOUBLES_EQUAL(100 * (std::acos(0.05) - 0.05 * std::sqrt(1 - 0.0025)) - 15, whole - left, 1e-9);
    LONGS_EQUAL(1, common(ring, half).contours.size());
}

}  // namespace

}  // namespace cusp::test
