// Which cutters count what another has cleared as cleared.
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "host_tools/clearing/nested_tools.hpp"

using namespace cusp::host;

namespace {

constexpr Tool kFlat6{1, ToolShape::kFlat, 6, 0};
constexpr Tool kFlat3{2, ToolShape::kFlat, 3, 0};
constexpr Tool kBall6{3, ToolShape::kBall, 6, 6};
constexpr Tool kBall3{4, ToolShape::kBall, 3, 3};

// What a cutter with its axis at 0 leaves at a distance, and what another at `apart` cuts there.
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

TEST_GROUP(NestedReach){};

TEST(NestedReach, OfFlatEndsIsTheDifferenceOfTheirRadii)
{
    DOUBLES_EQUAL(3, *nested_reach(kFlat6, kFlat3, 0), 1e-9);
    DOUBLES_EQUAL(-3, *nested_reach(kFlat3, kFlat6, 0), 1e-9);
}

TEST(NestedReach, OfBallsMeetsTheRidgeAndNoMore)
{
    const double reach = *nested_reach(kBall6, kBall3, 0.05);
    CHECK(reach > 0.4);
    CHECK(deepest_meeting(kBall6, kBall3, reach) <= 0.05 + 1e-6);
    CHECK(deepest_meeting(kBall6, kBall3, reach + 0.05) > 0.05);
}

TEST(NestedReach, OfAFlatEndUnderABallIsWhereAllOfItStandsOnTheRidges)
{
    // sqrt(0.1 (2 6 - 0.1)) of the ball are flat enough; 3 mm of the flat end must lie within.
    DOUBLES_EQUAL(std::sqrt(0.1 * 11.9) - 3, *nested_reach(kBall6, kFlat3, 0.1), 0.02);
    CHECK(!leaves_nothing_for(kBall6, kFlat3, 0.1));
}

TEST(NestedReach, KnowsThatARoundSmallCutterLeavesTheFootOfTheWallToALargeFlatOne)
{
    CHECK(leaves_nothing_for(kFlat3, kFlat6, 0));
    CHECK(leaves_nothing_for(kFlat3, kBall6, 0));
    CHECK(leaves_nothing_for(kBall3, kBall6, 0));
    CHECK(!leaves_nothing_for(kBall3, kFlat6, 0.1));
    CHECK(!leaves_nothing_for(kFlat6, kFlat3, 0));
}
