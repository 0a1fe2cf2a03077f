#include "host_tools/geometry/offset/region_check.hpp"

#include "CppUTest/TestHarness.h"

#include "tests/unit/offset/polygons.hpp"

namespace cusp::test {

using namespace offset;

namespace {

TEST_GROUP(RegionCheck){};

TEST(RegionCheck, AcceptsASquareWithAHole)
{
    CHECK(!find_fault({{square(0, 0, 10), reversed(square(0, 0, 3))}}));
}

TEST(RegionCheck, NamesTheContourThatCrossesItself)
{
    const auto fault = find_fault({{polygon({{0, 0}, {10, 10}, {10, 0}, {0, 10}})}});
    CHECK(fault.has_value());
    CHECK(fault->kind == RegionFaultKind::kCrossesItself);
    DOUBLES_EQUAL(5.0, fault->where.x, 1e-9);
}

TEST(RegionCheck, FindsHolesThatCrossLieOutsideOrLieInEachOther)
{
    const auto crossing = find_fault({{square(0, 0, 10), reversed(square(9, 0, 3))}});
    CHECK(crossing->kind == RegionFaultKind::kCross);
    const auto outside = find_fault({{square(0, 0, 10), reversed(square(30, 0, 3))}});
    CHECK(outside->kind == RegionFaultKind::kHoleOutside);
    const auto nested =
        find_fault({{square(0, 0, 10), reversed(square(0, 0, 5)), reversed(square(0, 0, 2))}});
    CHECK(nested->kind == RegionFaultKind::kHoleInHole);
}

TEST(RegionCheck, FindsTheSameHoleTwice)
{
    const Contour hole = reversed(square(0, 0, 3));
    CHECK(find_fault({{square(0, 0, 10), hole, hole}})->kind == RegionFaultKind::kHoleInHole);
    CHECK(!find_fault({{square(0, 0, 10), hole, reversed(square(6, 0, 3))}}));
}

TEST(RegionCheck, FindsAnEdgeWithoutLength)
{
    const auto fault = find_fault({{polygon({{0, 0}, {10, 0}, {10, 0}, {0, 10}})}});
    CHECK(fault->kind == RegionFaultKind::kNoLength);
}

}  // namespace
}  // namespace cusp::test
