#include "host_tools/geometry/offset/region_overlay.hpp"

#include "CppUTest/TestHarness.h"

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
    DOUBLES_EQUAL(both, area(common(a, b).value()), 1e-9);
    DOUBLES_EQUAL(800 - both, area(united(a, b).value()), 1e-9);
    DOUBLES_EQUAL(400 - both, area(without(a, b).value()), 1e-9);
}

TEST(RegionOverlay, OfRegionsWhoseContoursDoNotMeet)
{
    const Region2d a{{square(0, 0, 10)}};
    const Region2d inside{{square(1, 1, 3)}};
    const Region2d apart{{square(40, 0, 5)}};
    LONGS_EQUAL(2, without(a, inside)->contours.size());
    LONGS_EQUAL(1, united(a, inside)->contours.size());
    LONGS_EQUAL(2, united(a, apart)->contours.size());
    LONGS_EQUAL(0, common(a, apart)->contours.size());
    LONGS_EQUAL(0, without(inside, a)->contours.size());
}

TEST(RegionOverlay, CutsArcsAndHoles)
{
    const Contour disc{
        arc_edge({10, 0}, {0, 10}, {0, 0}, 1), arc_edge({0, 10}, {-10, 0}, {0, 0}, 1),
        arc_edge({-10, 0}, {0, -10}, {0, 0}, 1), arc_edge({0, -10}, {10, 0}, {0, 0}, 1)};
    const Region2d ring{{disc, reversed(square(0, 0, 3))}};
    const Region2d half{{rectangle(-20, -20, 0.5, 20)}};
    const double whole = area(ring);
    const double left = area(common(ring, half).value());
    DOUBLES_EQUAL(whole, left + area(without(ring, half).value()), 1e-9);
    // Right of x = 0.5: the segment of the disc, less 2.5 x 6 of the hole.
    DOUBLES_EQUAL(100 * (std::acos(0.05) - 0.05 * std::sqrt(1 - 0.0025)) - 15, whole - left, 1e-9);
    LONGS_EQUAL(1, common(ring, half)->contours.size());
}

}  // namespace

}  // namespace cusp::test
