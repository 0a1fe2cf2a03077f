// True if the area cleared by one cutter counts as cleared for another.
#include "host_tools/cam/clearing/rest_between_tools.hpp"

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::clearing;
using namespace cusp::toolpath;

namespace {

constexpr Tool kFlat6{1, ToolShape::kFlat, 6, 0};
constexpr Tool kFlat3{2, ToolShape::kFlat, 3, 0};
constexpr Tool kBall6{3, ToolShape::kBall, 6, 6};
constexpr Tool kBall3{4, ToolShape::kBall, 3, 3};

// Height left at a distance by a cutter with its axis at 0, and the cut there by another at `apart`.
double deepest_meeting(const Tool& before, const Tool& after, double apart)
{
    double deepest = 0;
    for (int i = -100; i <= 100; ++i) {
        const double at = after.radius * i / 100;
        const double from_before = std::abs(at + apart);
        if (from_before <= before.radius) {
            deepest = std::max(
                deepest, profile_height(before, from_before) - profile_height(after, std::abs(at)));
        }
    }
    return deepest;
}

}  // namespace

TEST_GROUP(RestBetweenTools){};

TEST(RestBetweenTools, OfFlatEndsIsTheDifferenceOfTheirRadii)
{
    DOUBLES_EQUAL(3, *rest_offset_between_tools(kFlat6, kFlat3, 0), 1e-9);
    DOUBLES_EQUAL(-3, *rest_offset_between_tools(kFlat3, kFlat6, 0), 1e-9);
}

TEST(RestBetweenTools, OfBallsMeetsTheRidgeAndNoMore)
{
    const double reach = *rest_offset_between_tools(kBall6, kBall3, 0.05);
    CHECK(reach > 0.4);
    CHECK(deepest_meeting(kBall6, kBall3, reach) <= 0.05 + 1e-6);
    CHECK(deepest_meeting(kBall6, kBall3, reach + 0.05) > 0.05);
}

TEST(RestBetweenTools, OfAFlatEndUnderABallIsWhereAllOfItIsOnTheRidges)
{
    // sqrt(0.1 (2 6 - 0.1)) of the ball are flat enough; 3 mm of the flat end must lie within.
    DOUBLES_EQUAL(std::sqrt(0.1 * 11.9) - 3, *rest_offset_between_tools(kBall6, kFlat3, 0.1), 0.02);
    CHECK(!leaves_no_rest(kBall6, kFlat3, 0.1));
}

TEST(RestBetweenTools, KnowsThatARoundSmallCutterLeavesTheFootOfTheWallToALargeFlatOne)
{
    CHECK(leaves_no_rest(kFlat3, kFlat6, 0));
    CHECK(leaves_no_rest(kFlat3, kBall6, 0));
    CHECK(leaves_no_rest(kBall3, kBall6, 0));
    CHECK(!leaves_no_rest(kBall3, kFlat6, 0.1));
    CHECK(!leaves_no_rest(kFlat6, kFlat3, 0));
}
